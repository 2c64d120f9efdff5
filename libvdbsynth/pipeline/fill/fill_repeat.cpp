// Applies a map to a kept model with a hole: the last step of filling, and all of its repetition.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/pipeline/fill/fill_steps.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace vdbsynth {
namespace {

constexpr float kTrust = 0.5f;  // [voxels] by which a distance may extend into the hole
constexpr float kLeast = 0.3f;  // [voxels] of a voxel that keeps its sign

// A distance may be trusted if the surface point it refers to is outside the hole.
bool trusted(float distance, float fromHole) {
    return fromHole >= 0 && std::abs(distance) <= fromHole + kTrust;
}

// The filled hole; around it the old field, without distances that refer to removed surfaces.
BrickField joined(const Surroundings& around, const BrickField& filled, const RunContext& ctx) {
    return BrickField::generate(filled.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float known[BrickField::kSamples], fromHole[BrickField::kSamples], open[BrickField::kSamples];
        filled.readBox(brick.min, brick.size(), samples);
        around.open.readBox(brick.min, brick.size(), open);
        around.known.readBox(brick.min, brick.size(), known);
        around.hole.readBox(brick.min, brick.size(), fromHole);
        for (int i = 0; i < BrickField::kSamples; ++i) {
            if (fromHole[i] < 0) continue;
            const float side = known[i] < 0 ? -1.f : 1.f;
            samples[i] = open[i] == 0.f ? known[i] : side * std::max(kLeast, side * samples[i]);
        }
    });
}

// A copy of the partial with the voxels around the hole from another grid.
FloatGridPtr replacedAround(const openvdb::FloatGrid& partial, const openvdb::FloatGrid& hole,
                            const IndexBox& holeBox, const openvdb::FloatGrid& rebuilt) {
    openvdb::FloatGrid::Ptr result = partial.deepCopy();
    auto to = result->getAccessor();
    const auto from = rebuilt.getConstAccessor(), distance = hole.getConstAccessor();
    const float reach = kHalfWidth * float(voxelSizeOf(partial));
    const IndexBox box = holeBox.expanded(int(kHalfWidth) + 1);
    forEachVoxel(box, [&](const Index3& p) {
        const openvdb::Coord c = toCoord(p);
        if (distance.getValue(c) >= reach) return;
        float value;
        if (from.probeValue(c, value))
            to.setValueOn(c, value);
        else
            to.setValueOff(c, value);
    });
    result->pruneGrid();
    return result;
}

}  // namespace

Surroundings surroundingsOf(const LevelSet& partial, const openvdb::FloatGrid& hole, IndexBox box,
                            const RunContext& ctx) {
    Surroundings around;
    if (partial.domainRecorded) {
        box = box.intersection(partial.domain);
        if (box.empty())
            throw Error(ErrorCode::Unusable,
                        "`hole`: lies outside the model's domain " + boxText(partial.domain));
        for (int axis = 0; axis < 3; ++axis) {
            around.cut[std::size_t(2 * axis)] = box.min[axis] == partial.domain.min[axis];
            around.cut[std::size_t(2 * axis + 1)] = box.max[axis] == partial.domain.max[axis];
        }
    }
    around.box = box;
    around.known = gatherWideBand(*partial.grid, box, around.cut, kFillBand, ctx);
    around.hole = gatherWideBand(hole, box, {}, kFillBand, ctx);
    return around;
}

void markOpen(Surroundings& around, bool guessed, const RunContext& ctx) {
    around.open = BrickField::generate(around.known.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float known[BrickField::kSamples], fromHole[BrickField::kSamples];
        around.known.readBox(brick.min, brick.size(), known);
        around.hole.readBox(brick.min, brick.size(), fromHole);
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const bool says =
                guessed ? fromHole[i] >= 0 : trusted(known[i], fromHole[i]) || fromHole[i] >= kFillBand;
            samples[i] = says ? 0.f : 1.f;
        }
    });
}

SelfExemplar selfExemplar(const LevelSet& partial, const openvdb::FloatGrid& hole, const IndexBox& box,
                          bool guessed, const RunContext& ctx) {
    Surroundings all = surroundingsOf(partial, hole, box, ctx);
    markOpen(all, guessed, ctx);
    SelfExemplar self;
    self.mask = BrickField::generate(all.open.box(), ctx, [&](const IndexBox& brick, float* samples) {
        all.open.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = 1 - samples[i];
    });
    self.field = std::move(all.known);
    self.box = all.box;
    return self;
}

BrickField fillExemplar(const LevelSet& exemplar, const IndexBox& box, const CutFaces& cut,
                        const RunContext& ctx) {
    return gatherWideBand(*exemplar.grid, box, cut, kFillBand, ctx);
}

FloatGridPtr holeGridOf(const MappedHole& hole, const openvdb::FloatGrid& like, const RunContext& ctx) {
    const FloatGridPtr grid =
        scatterBricks(hole.distance, hole.corner, float(voxelSizeOf(like)), kHalfWidth, ctx);
    grid->setTransform(like.transform().copy());
    return grid;
}

LevelSet fillThroughMap(const SourceMap& map, const Surroundings& around, const BrickField& filled,
                        const LevelSet& partial, const openvdb::FloatGrid& hole, const LevelSet& from,
                        const RunContext& ctx) {
    const CloseOptions close{around.cut, kHalfWidth, kHalfWidth, voxelSizeOf(*partial.grid), false};
    const BrickField band = closedBand(joined(around, filled, ctx), around.box.min, close, ctx);
    const FloatGridPtr rebuilt = levelSetFrom(band, kHalfWidth, *partial.grid, "the filled model", ctx);
    LevelSet model = partial;
    // The source mesh has the hole.
    model.source = nullptr;
    model.grid = replacedAround(*partial.grid, hole, solidBox(hole, "the hole"), *rebuilt);
    std::vector<GridPtr> kept;
    for (const GridPtr& grid : partial.attributes)
        if (!isOfSourceMap(grid->getName())) kept.push_back(grid->deepCopyGrid());
    model.attributes =
        transferToVoxels(mappedVoxels(map, *model.grid, ctx), {&from}, *model.grid, std::move(kept), ctx);
    model.attributes = transferBeyondBand(map, {&from}, *model.grid, std::move(model.attributes), ctx);
    if (!partial.domainRecorded) model.domain = solidBox(*model.grid, "the filled model");
    stampLevelSet(model);
    return model;
}

LevelSet repeatFill(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                    const LevelSet& partial, const RunContext& ctx) {
    const MappedExemplar& mapped = map.exemplars.front();
    requireMemory(ctx,
                  double(mapped.box.volume()) * 6 + double(map.targetBox.volume()) * 24 +
                      double(map.hole.distance.box().volume()) * 8,
                  "the filled hole", "use models of larger voxels");
    const FloatGridPtr hole = holeGridOf(map.hole, *partial.grid, ctx);
    Surroundings around = surroundingsOf(partial, *hole, map.targetBox, ctx);
    if (!(around.box == map.targetBox))
        throw Error(ErrorCode::ShapeMismatch, "the kept model's domain " + boxText(partial.domain) +
                                                  " does not hold the map's box " + boxText(map.targetBox));
    markOpen(around, map.hole.guessed, ctx);
    const BrickField field = exemplars.empty()
                                 ? selfExemplar(partial, *hole, mapped.box, map.hole.guessed, ctx).field
                                 : fillExemplar(*exemplars.front(), mapped.box, mapped.cut, ctx);
    const BrickField filled = voteThroughMap(map.patches, {std::make_shared<const BrickField>(field)}, ctx);
    return fillThroughMap(map, around, filled, partial, *hole,
                          exemplars.empty() ? partial : *exemplars.front(), ctx);
}

}  // namespace vdbsynth
