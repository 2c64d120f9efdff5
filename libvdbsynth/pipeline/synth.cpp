#include "libvdbsynth/pipeline/synth.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/pipeline/carry.h"
#include "libvdbsynth/synth/texture_optimization.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/mask.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr int kObjectMargin = 4;  // [voxels] of air kept around an object: its band and one more

struct Plan {
    BlockSynthesisOptions block;
    SourceMap map;
};

Index3 halfOf(const Index3& n) {
    return {(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2};
}

Index3 targetSize(const Index3& domain, const SynthOptions& options) {
    Index3 size;
    for (int axis = 0; axis < 3; ++axis) {
        const double given = options.size[std::size_t(axis)];
        const double voxels = options.multiple[std::size_t(axis)] ? given * domain[axis] : given;
        requireOption(std::isfinite(voxels) && voxels >= 1 && voxels <= 1 << 20, "size",
                      std::to_string(given), "at least the exemplar's domain and at most 1048576 voxels");
        size[axis] = int(std::lround(voxels));
        if (size[axis] < domain[axis])
            throw Error(ErrorCode::Unusable,
                        "--size: " + std::to_string(size[axis]) + " voxels along " + char('x' + axis) +
                            " is smaller than the exemplar's domain (" + std::to_string(domain[axis]) +
                            "); give at least that, or 1x");
    }
    return size;
}

// A target that tiles is worked on with more than a block of its other end on either side.
void addRoomToTile(Plan& plan, const SynthOptions& options) {
    for (int axis = 0; axis < 3; ++axis) {
        if (plan.block.border[std::size_t(axis)] != Border::Tile) continue;
        if (options.method != SynthesisMethod::Default || options.draft)
            throw Error(ErrorCode::InvalidOption, "--border tile: needs --method default and no --draft");
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

Plan makePlan(const LevelSet& exemplar, const SynthOptions& options) {
    Plan plan;
    const IndexBox domain = options.exemplarBox    ? *options.exemplarBox
                            : options.exemplarMask ? activeBox(*options.exemplarMask)
                                                   : exemplar.domain;
    const bool recorded = options.exemplarBox || options.exemplarMask || exemplar.domainRecorded;
    const Index3 size = targetSize(domain.size(), options);
    plan.map.targetDomain = {domain.min, domain.min + size - Index3{1, 1, 1}};
    plan.map.exemplarBox = plan.map.exemplarDomain = domain;
    plan.map.targetBox = plan.map.targetDomain;
    for (int axis = 0; axis < 3; ++axis) {
        const Border border =
            options.border[std::size_t(axis)].value_or(recorded ? Border::Cut : Border::Object);
        plan.block.border[std::size_t(axis)] = border;
        plan.map.cut[std::size_t(2 * axis)] = plan.map.cut[std::size_t(2 * axis + 1)] =
            border != Border::Object;
        if (border != Border::Object) continue;
        for (IndexBox* box : {&plan.map.exemplarBox, &plan.map.targetBox}) {
            box->min[axis] -= kObjectMargin;
            box->max[axis] += kObjectMargin;
        }
    }
    addRoomToTile(plan, options);
    plan.block.size = plan.map.targetBox.size();
    plan.block.block = options.block;
    plan.block.levels = options.levels;
    plan.block.drift = options.drift;
    plan.block.paper = options.method == SynthesisMethod::Paper;
    validateSynthesis({plan.map.exemplarBox.size()}, plan.block);
    if (plan.block.block == 0) plan.block.block = deriveBlock(plan.map.exemplarBox.size(), plan.block);
    return plan;
}

// The plan at half the resolution, if the exemplar is large enough for it.
void planDraft(Plan& plan, const RunContext& ctx) {
    BlockSynthesisOptions coarse = plan.block;
    coarse.size = halfOf(plan.block.size);
    // The same block in the world, so that the draft has the choice that the full result has.
    const int block = std::min(std::max(4, plan.block.block / 4 * 2),
                               longestBlock(halfOf(plan.map.exemplarBox.size()), coarse));
    if (block < 4) {
        message(ctx, MessageLevel::Note,
                "--draft: the exemplar is too small for half the resolution; all of it is used");
        return;
    }
    coarse.block = block;
    coarse.levels = std::max(1, (plan.block.levels > 0 ? plan.block.levels : 3) - 1);
    coarse.drift = plan.block.drift / 2;
    plan.block = coarse;
    plan.map.draft = true;
}

void requireRoom(const RunContext& ctx, const SourceMap& map, const FloatGridPtr& grid) {
    // The surface grows with the volume. An active voxel of the result costs its share of field, vote, mesh
    // and distances; one of the exemplar's widened band its share of field, pyramids and index.
    const double growth =
        double(map.targetBox.volume()) / double(std::max<std::int64_t>(map.exemplarBox.volume(), 1));
    const double active = double(grid->activeVoxelCount());
    const double bytes = growth * active * 60 + active * double(map.band) / kHalfWidth * 40 +
                         double(map.targetBox.volume()) * (8.0 / 512 + 0.5);
    requireMemory(ctx, bytes,
                  "a result of " + std::to_string(map.targetBox.size().x) + " x " +
                      std::to_string(map.targetBox.size().y) + " x " +
                      std::to_string(map.targetBox.size().z) + " voxels",
                  "use a smaller --size or larger voxels");
}

// The exemplar as blocks are looked for in it: at half the resolution for a draft.
std::shared_ptr<const BrickField> gatherForSearch(const SourceMap& map, const LevelSet& exemplar,
                                                  const RunContext& ctx) {
    Stage stage(ctx, "widening the exemplar's band", 1);
    const auto field = std::make_shared<const BrickField>(
        map.draft ? widenBandCoarse(*exemplar.grid, map.exemplarBox, map.cut, map.band / 2, ctx)
                  : widenBand(*exemplar.grid, map.exemplarBox, map.cut, map.band, ctx));
    stage.advance();
    return field;
}

// The exemplar as the result is read from it.
std::shared_ptr<const BrickField> gatherForVote(const SourceMap& map, const LevelSet& exemplar,
                                                const RunContext& ctx) {
    if (!map.draft) return gatherForSearch(map, exemplar, ctx);
    return std::make_shared<const BrickField>(gatherNarrowBand(*exemplar.grid, map.exemplarBox, ctx));
}

// The voted field as a level set.
LevelSet finish(const SourceMap& map, BrickField voted, const openvdb::FloatGrid& like,
                const RunContext& ctx) {
    LevelSet model;
    const BrickField field = clipped(map, std::move(voted), ctx);
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

}  // namespace

SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    Plan plan = makePlan(exemplar, options);
    const int block = plan.block.block;
    plan.map.band = std::max(8.f, float(block) / 2);
    plan.map.halfWidth = options.halfWidth;
    plan.map.voxelSize = voxelSizeOf(*exemplar.grid);
    plan.map.exemplarHash = levelSetHash(*exemplar.grid);
    if (options.draft) planDraft(plan, ctx);
    requireRoom(ctx, plan.map, exemplar.grid);
    message(ctx, MessageLevel::Detail,
            "domain " + boxText(plan.map.exemplarBox) + ", target " + boxText(plan.map.targetDomain) +
                ", block " + std::to_string(block) + ", band widened to " +
                std::to_string(int(plan.map.band)) + " voxels");
    const auto field = gatherForSearch(plan.map, exemplar, ctx);
    BrickField mask;
    if (options.exemplarMask) {
        mask = gatherMask(*options.exemplarMask, plan.map.exemplarBox, *exemplar.grid, ctx);
        if (plan.map.draft) mask = halvedMask(mask, ctx);
        plan.block.masks = {&mask};
    }
    BlockSynthesisResult synthesis = options.method == SynthesisMethod::Default
                                         ? optimizeTexture({field}, plan.block, ctx)
                                         : synthesizeBlocks({field}, plan.block, ctx);
    SynthResult result;
    plan.map.patches = std::move(synthesis.map);
    if (plan.map.draft) {
        plan.map.patches = plan.map.patches.scaled(2, plan.map.targetBox.size());
        synthesis.field = voteThroughMap(plan.map.patches, {gatherForVote(plan.map, exemplar, ctx)}, ctx);
    }
    result.model = finish(plan.map, synthesis.field, *exemplar.grid, ctx);
    result.model.carried = carryThroughMap(plan.map, exemplar, *result.model.grid, ctx);
    result.map = std::move(plan.map);
    result.stats = synthesis.stats;
    result.stats.block = result.map.patches.block;
    return result;
}

LevelSet repeatSynthesis(const SourceMap& map, const LevelSet& exemplar, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    const double ratio = map.voxelSize / voxelSizeOf(*exemplar.grid);
    const int factor = int(std::lround(ratio));
    if (factor < 1 || factor > 64 || std::abs(ratio - factor) > 1e-4 * ratio)
        throw Error(ErrorCode::ShapeMismatch,
                    "the exemplar's voxel size " + std::to_string(voxelSizeOf(*exemplar.grid)) +
                        " is not the map's " + std::to_string(map.voxelSize) +
                        " divided by a whole number; convert it with --voxel-size " +
                        std::to_string(map.voxelSize));
    if (factor == 1 && levelSetHash(*exemplar.grid) != map.exemplarHash)
        message(ctx, MessageLevel::Note,
                "the exemplar is not the one that the map was made with; its geometry is read instead");
    SourceMap scaled = map;
    if (factor > 1) {
        // Voxel i of the map covers fine voxels k*i + shift .. k*i + shift + k-1: the fine voxels whose
        // centres lie in it.
        const int shift = -((factor - 1) / 2);
        const auto finer = [&](const IndexBox& box) {
            const Index3 by{shift, shift, shift};
            return IndexBox{box.min * factor + by,
                            (box.max + Index3{1, 1, 1}) * factor + by - Index3{1, 1, 1}};
        };
        scaled.exemplarBox = finer(map.exemplarBox);
        scaled.targetBox = finer(map.targetBox);
        scaled.targetDomain = finer(map.targetDomain);
        scaled.band = map.band * float(factor);
        scaled.patches = map.patches.scaled(factor, scaled.targetBox.size());
        scaled.draft = false;  // what the finer exemplar is for
    }
    requireRoom(ctx, scaled, exemplar.grid);
    const auto field = gatherForVote(scaled, exemplar, ctx);
    float value = 0;
    if (field->constantIn(field->box(), value))
        throw Error(ErrorCode::ShapeMismatch, "the exemplar has no surface in the map's box " +
                                                  boxText(scaled.exemplarBox) +
                                                  "; it is not the map's exemplar or lies elsewhere");
    LevelSet model = finish(scaled, voteThroughMap(scaled.patches, {field}, ctx), *exemplar.grid, ctx);
    model.carried = carryThroughMap(scaled, exemplar, *model.grid, ctx);
    return model;
}

}  // namespace vdbsynth
