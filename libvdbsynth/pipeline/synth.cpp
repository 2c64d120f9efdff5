#include "libvdbsynth/pipeline/synth.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
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

Plan makePlan(const LevelSet& exemplar, const SynthOptions& options) {
    Plan plan;
    const IndexBox domain = options.exemplarBox ? *options.exemplarBox : exemplar.domain;
    const bool recorded = options.exemplarBox || exemplar.domainRecorded;
    const Index3 size = targetSize(domain.size(), options);
    plan.map.targetDomain = {domain.min, domain.min + size - Index3{1, 1, 1}};
    plan.map.exemplarBox = domain;
    plan.map.targetBox = plan.map.targetDomain;
    for (int axis = 0; axis < 3; ++axis) {
        const Border border =
            options.border[std::size_t(axis)].value_or(recorded ? Border::Cut : Border::Object);
        plan.block.border[std::size_t(axis)] = border;
        plan.map.cut[std::size_t(2 * axis)] = plan.map.cut[std::size_t(2 * axis + 1)] = border == Border::Cut;
        if (border == Border::Cut) continue;
        for (IndexBox* box : {&plan.map.exemplarBox, &plan.map.targetBox}) {
            box->min[axis] -= kObjectMargin;
            box->max[axis] += kObjectMargin;
        }
    }
    plan.block.size = plan.map.targetBox.size();
    plan.block.block = options.block;
    plan.block.levels = options.levels;
    plan.block.drift = options.drift;
    plan.block.draft = options.draft;
    return plan;
}

void requireRoom(const RunContext& ctx, const SourceMap& map, const FloatGridPtr& grid) {
    // The target's surface grows with its volume; a stored brick is 2 KiB of field, as much again of result,
    // and its share of band, mesh and map. Bricks that hold surface: those of the exemplar, scaled.
    const double growth =
        double(map.targetBox.volume()) / double(std::max<std::int64_t>(map.exemplarBox.volume(), 1));
    const double bytes =
        growth * double(grid->activeVoxelCount()) * 60 + double(map.targetBox.volume()) * (8.0 / 512 + 0.5);
    requireMemory(ctx, bytes,
                  "a result of " + std::to_string(map.targetBox.size().x) + " x " +
                      std::to_string(map.targetBox.size().y) + " x " +
                      std::to_string(map.targetBox.size().z) + " voxels",
                  "use a smaller --size or larger voxels");
}

LevelSet finish(const SourceMap& map, const BrickField& field, const openvdb::FloatGrid& like,
                const RunContext& ctx) {
    LevelSet model;
    model.grid = closeAndRebuild(field, map.targetBox.min, map.cut, map.halfWidth, like, "the result", ctx);
    model.domain = map.targetDomain;
    model.domainRecorded = true;
    stampLevelSet(model);
    return model;
}

std::shared_ptr<const BrickField> gatherExemplar(const SourceMap& map, const LevelSet& exemplar,
                                                 const RunContext& ctx) {
    return std::make_shared<const BrickField>(
        widenBand(*exemplar.grid, map.exemplarBox, map.cut, map.band, ctx));
}

}  // namespace

SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    Plan plan = makePlan(exemplar, options);
    requireRoom(ctx, plan.map, exemplar.grid);
    const int block =
        options.block > 0 ? options.block : deriveBlock(plan.map.exemplarBox.size(), plan.block);
    plan.block.block = block;
    plan.map.band = std::max(8.f, float(block) / 2);
    plan.map.halfWidth = options.halfWidth;
    plan.map.voxelSize = voxelSizeOf(*exemplar.grid);
    plan.map.exemplarHash = levelSetHash(*exemplar.grid);
    message(ctx, MessageLevel::Detail,
            "domain " + boxText(plan.map.exemplarBox) + ", target " + boxText(plan.map.targetDomain) +
                ", block " + std::to_string(block));
    {
        Stage stage(ctx, "widening the band to " + std::to_string(int(plan.map.band)) + " voxels", 1);
        message(ctx, MessageLevel::Detail,
                "the exemplar's band is re-distanced to " + std::to_string(int(plan.map.band)) +
                    " voxels a side");
    }
    const auto field = gatherExemplar(plan.map, exemplar, ctx);
    BrickField mask;
    if (options.exemplarMask) {
        mask = gatherMask(*options.exemplarMask, plan.map.exemplarBox, *exemplar.grid, ctx);
        plan.block.mask = &mask;
    }
    BlockSynthesisResult synthesis = synthesizeBlocks({field}, plan.block, ctx);
    SynthResult result;
    plan.map.patches = std::move(synthesis.map);
    result.model = finish(plan.map, synthesis.field, *exemplar.grid, ctx);
    result.map = std::move(plan.map);
    result.stats = synthesis.stats;
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
    }
    requireRoom(ctx, scaled, exemplar.grid);
    const auto field = gatherExemplar(scaled, exemplar, ctx);
    float value = 0;
    if (field->constantIn(field->box(), value))
        throw Error(ErrorCode::ShapeMismatch, "the exemplar has no surface in the map's box " +
                                                  boxText(scaled.exemplarBox) +
                                                  "; it is not the map's exemplar or lies elsewhere");
    return finish(scaled, voteThroughMap(scaled.patches, {field}, ctx), *exemplar.grid, ctx);
}

}  // namespace vdbsynth
