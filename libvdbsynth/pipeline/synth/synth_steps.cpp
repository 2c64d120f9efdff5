// Steps of synth and repeat before and after the synthesis: boxes, fields, the final level set.
#include "libvdbsynth/pipeline/synth/synth_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/distance/widen_band.h"
#include "libvdbsynth/grid/islands.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/mask.h"

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

// A target that tiles is synthesized with more than a block of its other end on either side.
void padForTiling(SynthPlan& plan, const SynthOptions& options) {
    for (int axis = 0; axis < 3; ++axis) {
        if (plan.block.border[std::size_t(axis)] != Border::Tile) continue;
        if (options.method != SynthesisMethod::Default || options.draft)
            throw Error(ErrorCode::InvalidOption, "`border` tile: needs `method` default and no `draft`");
        // Two blocks, rounded up to sixteens, so that coarser passes divide evenly.
        const int around = (2 * (options.block > 0 ? options.block : 16) + 15) / 16 * 16;
        plan.block.around[axis] = around;
        plan.map.targetBox.min[axis] -= around;
        plan.map.targetBox.max[axis] += around;
    }
}

// The part of a voted field that the result uses: cut axes end with the domain.
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

// At most half a block a side, and no larger than the components of a scaled exemplar.
void removeIslandsOf(const SourceMap& map, const ExemplarFields& exemplars, BrickField& field,
                     const RunContext& ctx) {
    const std::uint64_t half = std::uint64_t(map.matched / 2);
    double least = 1;
    for (const ExemplarVariant& variant : map.variants) least = std::min(least, variant.scale);
    Stage stage(ctx, "removing islands", 2);
    for (const bool ofVoid : {false, true}) {
        IslandLimits limits = islandLimits(exemplars, half * half * half, ofVoid, ctx);
        limits.interior = std::uint64_t(double(limits.interior) * least * least * least);
        limits.cut = std::uint64_t(double(limits.cut) * least * least * least);
        const std::size_t changed = removeIslands(field, limits, ofVoid, ctx);
        message(ctx, MessageLevel::Detail,
                std::to_string(changed) + " voxels in islands of the " + (ofVoid ? "void" : "solid") +
                    " were flipped");
        stage.advance();
    }
}

// Controls need the default method at the full resolution.
void requireDefaultMethod(const SynthOptions& options, const SynthPlan& plan) {
    const std::pair<const GridConstPtr&, const char*> controls[] = {{options.exemplarMap, "exemplarMap"},
                                                                    {options.rotationMap, "rotationMap"},
                                                                    {options.scaleMap, "scaleMap"},
                                                                    {options.guide, "guide"}};
    for (const auto& [grid, name] : controls)
        if (grid && (options.method != SynthesisMethod::Default || options.draft))
            throw Error(ErrorCode::InvalidOption,
                        std::string("`") + name + "`: needs `method` default and no `draft`");
    if (options.direction && (options.method != SynthesisMethod::Default || options.draft))
        throw Error(ErrorCode::InvalidOption, "`direction`: needs `method` default and no `draft`");
    const bool object = std::count(plan.block.border.begin(), plan.block.border.end(), Border::Object) > 0;
    if (object && rotatesOrScales(options))
        throw Error(ErrorCode::InvalidOption,
                    "`rotationMap`, `scaleMap`, `direction`: an object border cannot be rotated; give "
                    "`border` cut or tile");
}

// Several exemplars: each with its own domain, but along axes that do not grow the first one's extent.
void addExemplars(const LevelSets& exemplars, const SynthOptions& options, SynthPlan& plan) {
    SourceMap& map = plan.map;
    std::array<bool, 3> grown{};
    for (int axis = 0; axis < 3; ++axis)
        grown[std::size_t(axis)] = map.targetBox.size()[axis] != map.exemplars.front().box.size()[axis];
    if (exemplars.size() > 1 || rotatesOrScales(options)) plan.block.grows = grown;
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
}

// Which models the exemplars are.
void identify(const LevelSets& exemplars, SourceMap& map) {
    map.voxelSize = voxelSizeOf(*exemplars.front()->grid);
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        map.exemplars[e].transform = transformOf(*exemplars[e]->grid);
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        map.exemplars[e].hash = levelSetHash(*exemplars[e]->grid);
}

// The plan at half the resolution, if the exemplars are large enough for it.
void planDraft(SynthPlan& plan, const RunContext& ctx) {
    BlockSynthesisOptions coarse = plan.block;
    coarse.size = halfOf(plan.block.size);
    // The same block in the world, so that the draft has the choice that the full result has.
    int block = std::max(4, plan.block.block / 4 * 2);
    for (const MappedExemplar& exemplar : plan.map.exemplars)
        block = std::min(block, longestBlock(halfOf(exemplar.box.size()), coarse));
    if (block < 4) {
        message(ctx, MessageLevel::Note,
                "`draft`: the exemplar is too small for half the resolution; its full resolution is used");
        return;
    }
    coarse.block = block;
    coarse.levels = std::max(1, (plan.block.levels > 0 ? plan.block.levels : 3) - 1);
    coarse.drift = plan.block.drift / 2;
    plan.block = coarse;
    plan.map.draft = true;
}

}  // namespace

SynthPlan planSynthesis(const LevelSets& exemplars, const SynthOptions& options, const RunContext& ctx) {
    SynthPlan plan;
    const LevelSet& exemplar = *exemplars.front();
    MappedExemplar first;
    first.domain = options.exemplarBox ? *options.exemplarBox : exemplar.domain;
    if (options.exemplarMask && !options.exemplarBox) {
        const IndexBox masked = activeBox(*options.exemplarMask), shared = masked.intersection(first.domain);
        first.domain = shared.empty() ? masked : shared;
        if (!(first.domain == exemplar.domain))
            message(ctx, MessageLevel::Note,
                    "the exemplar's domain, to which sizes refer, is now the box of `exemplarMask`: " +
                        boxText(first.domain));
    }
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
    padForTiling(plan, options);
    if (options.origin) plan.map.moved = movedTo(*options.origin, plan.map.targetDomain, *exemplar.grid);
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
    message(ctx, MessageLevel::Detail,
            "domain " + boxText(plan.map.exemplars.front().box) + ", target " +
                boxText(plan.map.targetDomain) + ", block " + std::to_string(plan.block.block) +
                ", band widened to " + std::to_string(int(plan.map.band)) + " voxels");
    if (options.draft) planDraft(plan, ctx);
    plan.bytes = requireMemoryFor(ctx, plan.map, exemplars);
    identify(exemplars, plan.map);
    return plan;
}

Vec3d movedTo(const Vec3d& origin, const IndexBox& domain, const openvdb::FloatGrid& like) {
    const openvdb::Vec3d corner(domain.min.x - 0.5, domain.min.y - 0.5, domain.min.z - 0.5);
    return origin - fromVec(like.transform().indexToWorld(corner));
}

FloatGridConstPtr movedGrid(const openvdb::FloatGrid& grid, const Vec3d& by) {
    const openvdb::math::Transform::Ptr transform = grid.transform().copy();
    transform->postTranslate(toVec(by));
    return grid.copyReplacingTransform(transform);
}

double requireMemoryFor(const RunContext& ctx, const SourceMap& map, const LevelSets& exemplars) {
    // The surface grows with the volume. An active voxel of the result costs its share of field, vote, mesh
    // and distances (60 bytes); one of an exemplar's widened band its share of field, pyramids and index
    // (40); a voxel of a variant 16; seams are cut with 4.5 for each voxel of the result. Tuned with
    // tools/dev/memory_models.py: at 256^3 the sum is 1.4 to 1.8 times the peak, at 128^3, where the
    // program's own memory counts, 0.6 to 0.8.
    double active = 0, volume = 0, variants = 0;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        active += double(exemplars[e]->grid->activeVoxelCount());
        volume += double(map.exemplars[e].box.volume());
    }
    // A constant brick costs eight bytes.
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
    return bytes;
}

SearchedFields gatherExemplars(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx) {
    Stage stage(ctx, "widening the exemplar's band", 2);
    const float band = map.draft ? map.band / 2 : map.band;
    SearchedFields fields;
    std::vector<KnownBand> known;
    for (std::size_t e = 0; e < exemplars.size(); ++e) {
        const openvdb::FloatGrid& grid = *exemplars[e]->grid;
        const IndexBox& box = map.exemplars[e].box;
        known.push_back(gatherKnownBand(grid, box, map.cut, (map.draft ? 2 : 1) * reachToWiden(band), ctx));
        if (map.draft)
            fields.read.push_back(std::make_shared<const BrickField>(gatherNarrowBand(grid, box, ctx)));
    }
    stage.advance();
    for (const KnownBand& each : known)
        fields.searched.push_back(std::make_shared<const BrickField>(
            map.draft ? widenBandCoarse(each, band, ctx) : widenBand(each, band, ctx)));
    if (!map.draft) fields.read = fields.searched;
    stage.advance();
    return fields;
}

ExemplarFields gatherForVote(const SourceMap& map, const LevelSets& exemplars, const RunContext& ctx) {
    if (!map.draft) return gatherExemplars(map, exemplars, ctx).read;
    ExemplarFields fields;
    for (std::size_t e = 0; e < exemplars.size(); ++e)
        fields.push_back(std::make_shared<const BrickField>(
            gatherNarrowBand(*exemplars[e]->grid, map.exemplars[e].box, ctx)));
    return fields;
}

LevelSet finishSynthesis(const SourceMap& map, BrickField voted, const ExemplarFields& exemplars,
                         const openvdb::FloatGrid& like, const RunContext& ctx) {
    LevelSet model;
    BrickField field = clipped(map, std::move(voted), ctx);
    removeIslandsOf(map, exemplars, field, ctx);
    Index3 corner = map.targetBox.min;
    for (int axis = 0; axis < 3; ++axis)
        if (map.cut[std::size_t(2 * axis)]) corner[axis] = map.targetDomain.min[axis];
    CloseOptions close;
    close.cut = map.cut;
    close.halfWidth = map.halfWidth;
    close.voxelSize = voxelSizeOf(like);
    close.draft = map.draft && map.halfWidth == kHalfWidth;
    const BrickField band = closedBand(field, corner, close, ctx);
    model.grid = levelSetFrom(band, map.halfWidth, like, "the result", ctx);
    if (dot(map.moved, map.moved) > 0)
        model.grid->setTransform(movedGrid(like, map.moved)->transform().copy());
    model.domain = map.targetDomain;
    model.domainRecorded = true;
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
