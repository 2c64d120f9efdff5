// What synth and repeat do before and after the synthesis: boxes, fields, the level set at the end.
#include "libvdbsynth/pipeline/synth_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/measure/crumbs.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <string>

namespace vdbsynth {
namespace {

constexpr int kObjectMargin = 4;  // [voxels] of air kept around an object: its band and one more

Index3 halfOf(const Index3& n) {
    return {(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
}

Index3 targetSize(const Index3& domain, const SynthOptions& options) {
    Index3 size;
    for (int axis = 0; axis < 3; ++axis) {
        const double voxels = options.size[axis].over(domain[axis]);
        requireOption(voxels >= 1 && voxels <= 1 << 20, "size", options.size.text(),
                      "at least the exemplar's domain and at most 1048576 voxels");
        size[axis] = int(std::lround(voxels));
        if (size[axis] < domain[axis])
            throw Error(ErrorCode::Unusable,
                        "`size`: " + std::to_string(size[axis]) + " voxels along " + char('x' + axis) +
                            " is smaller than the exemplar's domain (" + std::to_string(domain[axis]) +
                            "); give at least that, or 1x");
    }
    return size;
}

// A target that tiles is worked on with more than a block of its other end on either side.
void addRoomToTile(SynthPlan& plan, const SynthOptions& options) {
    for (int axis = 0; axis < 3; ++axis) {
        if (plan.block.border[std::size_t(axis)] != Border::Tile) continue;
        if (options.method != SynthesisMethod::Default || options.draft)
            throw Error(ErrorCode::InvalidOption, "`border` tile: needs `method` default and no `draft`");
        // Two blocks, in whole sixteens, so that coarser passes come out even.
        const int around = (2 * (options.block > 0 ? options.block : 16) + 15) / 16 * 16;
        plan.block.around[axis] = around;
        plan.map.targetBox.min[axis] -= around;
        plan.map.targetBox.max[axis] += around;
    }
}

// The part of a voted field that the result is made of: cut axes end with the domain.
BrickField clipped(const SourceMap& map, BrickField field, const RunContext& ctx) {
    IndexBox box = map.targetBox;
    for (int axis = 0; axis < 3; ++axis)
        if (map.cut[std::size_t(2 * axis)]) {
            box.min[axis] = map.targetDomain.min[axis];
            box.max[axis] = map.targetDomain.max[axis];
        }
    if (box == map.targetBox) return field;
    const Index3 shift = box.min - map.targetBox.min;
    return BrickField::generate(IndexBox::fromSize(box.size()), ctx,
                                [&](const IndexBox& brick, float* samples) {
                                    field.readBox(brick.min + shift, brick.size(), samples);
                                });
}

// Half a block a side at most, and no larger than what a scaled exemplar has.
void removeCrumbsOf(const SourceMap& map, const ExemplarFields& exemplars, BrickField& field,
                    const RunContext& ctx) {
    const std::uint64_t half = std::uint64_t(map.matched / 2);
    double least = 1;
    for (const ExemplarVariant& variant : map.variants) least = std::min(least, variant.scale);
    Stage stage(ctx, "removing crumbs", 2);
    for (const bool ofVoid : {false, true}) {
        CrumbLimits limits = crumbLimits(exemplars, half * half * half, ofVoid, ctx);
        limits.interior = std::uint64_t(double(limits.interior) * least * least * least);
        limits.cut = std::uint64_t(double(limits.cut) * least * least * least);
        const std::size_t changed = removeCrumbs(field, limits, ofVoid, ctx);
        message(ctx, MessageLevel::Detail,
                std::to_string(changed) + " voxels of crumbs of the " + (ofVoid ? "void" : "solid") +
                    " changed sides");
        stage.advance();
    }
}

// Controls work by the default method, at the full resolution.
void requireDefaultMethod(const SynthOptions& options, const SynthPlan& plan) {
    const std::pair<const GridConstPtr&, const char*> controls[] = {{options.exemplarMap, "exemplarMap"},
                                                                    {options.rotationMap, "rotationMap"},
                                                                    {options.scaleMap, "scaleMap"},
                                                                    {options.guide, "guide"}};
    for (const auto& [grid, name] : controls)
        if (grid && (options.method != SynthesisMethod::Default || options.draft))
            throw Error(ErrorCode::InvalidOption,
                        std::string("`") + name + "`: needs `method` default and no `draft`");
    const bool object = std::count(plan.block.border.begin(), plan.block.border.end(), Border::Object) > 0;
    if (object && (options.rotationMap || options.scaleMap))
        throw Error(
            ErrorCode::InvalidOption,
            "`rotationMap`, `scaleMap`: an object border cannot be rotated; give `border` cut or tile");
}

// Several exemplars: each its own domain, but along axes that do not grow the first one's extent.
void addExemplars(const LevelSets& exemplars, const SynthOptions& options, SynthPlan& plan) {
    SourceMap& map = plan.map;
    std::array<bool, 3> grown{};
    for (int axis = 0; axis < 3; ++axis)
        grown[std::size_t(axis)] = map.targetBox.size()[axis] != map.exemplars.front().box.size()[axis];
    if (exemplars.size() > 1 || options.rotationMap || options.scaleMap) plan.block.grows = grown;
    for (std::size_t e = 1; e < exemplars.size(); ++e) {
        MappedExemplar other;
        other.box = other.domain = exemplars[e]->domain;
        for (int axis = 0; axis < 3; ++axis) {
            if (plan.block.border[std::size_t(axis)] == Border::Object) {
                other.box.min[axis] -= kObjectMargin;
                other.box.max[axis] += kObjectMargin;
            }
            if (grown[std::size_t(axis)]) continue;
            other.box.min[axis] = map.exemplars.front().box.min[axis];
            other.box.max[axis] = map.exemplars.front().box.max[axis];
        }
        const double voxel = voxelSizeOf(*exemplars[e]->grid), first = voxelSizeOf(*exemplars[0]->grid);
        if (std::abs(voxel - first) > 1e-4 * first)
            throw Error(ErrorCode::ShapeMismatch,
                        "exemplar " + std::to_string(e + 1) + " has voxels of " + std::to_string(voxel) +
                            ", the first one of " + std::to_string(first) + "; convert it with `voxelSize` " +
                            std::to_string(first));
        map.exemplars.push_back(other);
    }
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        map.exemplars[e].hash = levelSetHash(*exemplars[e]->grid);
        map.exemplars[e].transform = transformOf(*exemplars[e]->grid);
    }
}

}  // namespace

SynthPlan planSynthesis(const LevelSets& exemplars, const SynthOptions& options) {
    SynthPlan plan;
    const LevelSet& exemplar = *exemplars.front();
    MappedExemplar first;
    first.domain = options.exemplarBox    ? *options.exemplarBox
                   : options.exemplarMask ? activeBox(*options.exemplarMask)
                                          : exemplar.domain;
    first.box = first.domain;
    bool recorded = options.exemplarBox || options.exemplarMask || exemplar.domainRecorded;
    for (std::size_t e = 1; e < exemplars.size(); ++e) recorded = recorded && exemplars[e]->domainRecorded;
    const Index3 size = targetSize(first.domain.size(), options);
    plan.map.targetDomain = {first.domain.min, first.domain.min + size - Index3{1, 1, 1}};
    plan.map.targetBox = plan.map.targetDomain;
    for (int axis = 0; axis < 3; ++axis) {
        const Border border =
            options.border[std::size_t(axis)].value_or(recorded ? Border::Cut : Border::Object);
        plan.block.border[std::size_t(axis)] = border;
        plan.map.cut[std::size_t(2 * axis)] = plan.map.cut[std::size_t(2 * axis + 1)] =
            border != Border::Object;
        if (border != Border::Object) continue;
        for (IndexBox* box : {&first.box, &plan.map.targetBox}) {
            box->min[axis] -= kObjectMargin;
            box->max[axis] += kObjectMargin;
        }
    }
    plan.map.exemplars = {first};
    requireDefaultMethod(options, plan);
    addRoomToTile(plan, options);
    plan.block.size = plan.map.targetBox.size();
    plan.block.block = options.block;
    plan.block.levels = options.levels;
    plan.block.longestRun = options.longestRun;
    plan.block.drift = options.drift;
    plan.block.indexCache = options.indexCache;
    plan.block.paper = options.method == SynthesisMethod::Paper;
    addExemplars(exemplars, options, plan);
    std::vector<Index3> sizes;
    for (const MappedExemplar& mapped : plan.map.exemplars) sizes.push_back(mapped.box.size());
    validate(plan.block, sizes);
    if (options.block == 0) {
        plan.block.block = 256;
        for (const Index3& each : sizes)
            plan.block.block = std::min(plan.block.block, deriveBlock(each, plan.block));
    }
    plan.map.band = std::max(8.f, float(plan.block.block) / 2);
    plan.map.halfWidth = options.halfWidth;
    plan.map.voxelSize = voxelSizeOf(*exemplar.grid);
    return plan;
}

void planDraft(SynthPlan& plan, const RunContext& ctx) {
    BlockSynthesisOptions coarse = plan.block;
    coarse.size = halfOf(plan.block.size);
    // The same block in the world, so that the draft has the choice that the full result has.
    int block = std::max(4, plan.block.block / 4 * 2);
    for (const MappedExemplar& exemplar : plan.map.exemplars)
        block = std::min(block, longestBlock(halfOf(exemplar.box.size()), coarse));
    if (block < 4) {
        message(ctx, MessageLevel::Note,
                "`draft`: the exemplar is too small for half the resolution; all of it is used");
        return;
    }
    coarse.block = block;
    coarse.levels = std::max(1, (plan.block.levels > 0 ? plan.block.levels : 3) - 1);
    coarse.drift = plan.block.drift / 2;
    plan.block = coarse;
    plan.map.draft = true;
}

void requireRoom(const RunContext& ctx, const SourceMap& map, const LevelSets& exemplars) {
    // The surface grows with the volume. An active voxel of the result costs its share of field, vote, mesh
    // and distances; one of an exemplar's widened band its share of field, pyramids and index. Seams are cut
    // with four bytes for each voxel of the result.
    double active = 0, volume = 0, variants = 0;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        active += double(exemplars[e]->grid->activeVoxelCount());
        volume += double(map.exemplars[e].box.volume());
    }
    // A brick costs eight bytes where it has one value.
    variants += volume / 1024;
    for (const ExemplarVariant& variant : map.variants)
        variants += double(variant.size.x) * double(variant.size.y) * double(variant.size.z);
    const double growth = double(map.targetBox.volume()) / std::max(volume, 1.0);
    const double bytes = growth * active * 60 + active * double(map.band) / kHalfWidth * 40 + variants * 16 +
                         double(map.targetBox.volume()) * (8.0 / 512 + 4.5);
    requireMemory(ctx, bytes,
                  "a result of " + std::to_string(map.targetBox.size().x) + " x " +
                      std::to_string(map.targetBox.size().y) + " x " +
                      std::to_string(map.targetBox.size().z) + " voxels",
                  "use a smaller `size` or larger voxels");
}

ExemplarFields gatherForSearch(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx) {
    Stage stage(ctx, "widening the exemplar's band", exemplars.size());
    ExemplarFields fields;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        const openvdb::FloatGrid& grid = *exemplars[e]->grid;
        const IndexBox& box = map.exemplars[e].box;
        fields.push_back(std::make_shared<const BrickField>(
            map.draft ? widenBandCoarse(grid, box, map.cut, map.band / 2, ctx)
                      : widenBand(grid, box, map.cut, map.band, ctx)));
        stage.advance();
    }
    return fields;
}

ExemplarFields gatherForVote(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx) {
    if (!map.draft) return gatherForSearch(map, exemplars, ctx);
    ExemplarFields fields;
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        fields.push_back(std::make_shared<const BrickField>(
            gatherNarrowBand(*exemplars[e]->grid, map.exemplars[e].box, ctx)));
    return fields;
}

ExemplarFields variantsOf(const SourceMap& map, const ExemplarFields& exemplars, const RunContext& ctx) {
    if (map.variants.empty()) return exemplars;
    Stage stage(ctx, "turning and scaling the exemplar", map.variants.size());
    ExemplarFields fields;
    for (const ExemplarVariant& variant : map.variants) {
        const auto& from = exemplars[std::size_t(variant.exemplar)];
        const bool same = variant.plain() && variant.size == from->box().size();
        fields.push_back(same ? from
                              : std::make_shared<const BrickField>(variantOf(*from, variant, map.band, ctx)));
        stage.advance();
    }
    return fields;
}

LevelSet finishSynthesis(const SourceMap& map, BrickField voted, const ExemplarFields& exemplars,
                         const openvdb::FloatGrid& like, const RunContext& ctx) {
    LevelSet model;
    BrickField field = clipped(map, std::move(voted), ctx);
    removeCrumbsOf(map, exemplars, field, ctx);
    Index3 corner = map.targetBox.min;
    for (int axis = 0; axis < 3; ++axis)
        if (map.cut[std::size_t(2 * axis)]) corner[axis] = map.targetDomain.min[axis];
    model.grid = map.draft && map.halfWidth == kHalfWidth
                     ? closeAndNormalize(field, corner, map.cut, like, "the result", ctx)
                     : closeAndRebuild(field, corner, map.cut, map.halfWidth, like, "the result", ctx);
    model.domain = map.targetDomain;
    model.domainRecorded = true;
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
