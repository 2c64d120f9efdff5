#include "libvdbsynth/pipeline/fill.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/grid/mesh_distance.h"
#include "libvdbsynth/pipeline/carry.h"
#include "libvdbsynth/synth/texture_optimization.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/zero_level.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/GridTransformer.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kBand = 8;           // [voxels] of distances that patches compare
constexpr float kTrust = 0.5f;       // [voxels] by which a distance may reach into the hole
constexpr float kLeast = 0.3f;       // [voxels] of a voxel that keeps its side
constexpr float kOffTheMesh = 1.5f;  // [voxels] of a place that is no face of the mesh
constexpr int kGuessedBlock = 8;     // [voxels] small, of which a damaged model has more whole patches
constexpr float kAroundSheet = 3.f;  // [voxels] of the balls round a sheet that closed a hole
constexpr double kMostVoxels = 4e9;

LevelSet holeFrom(const LevelSet& partial, const IndexBox& inside, const RunContext& ctx,
                  const std::function<float(const Index3&)>& distance) {
    const IndexBox box = inside.expanded(5);
    requireMemory(ctx, double(box.volume()) * 0.5, "the hole", "use a smaller one");
    const BrickField field =
        BrickField::generate(IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
            for (int x = brick.min.x; x <= brick.max.x; ++x)
                for (int y = brick.min.y; y <= brick.max.y; ++y)
                    for (int z = brick.min.z; z <= brick.max.z; ++z)
                        *samples++ = std::clamp(distance(box.min + Index3{x, y, z}), -kHalfWidth, kHalfWidth);
        });
    LevelSet hole;
    hole.grid = scatterBricks(field, box.min, float(voxelSizeOf(*partial.grid)), kHalfWidth, ctx);
    hole.grid->setTransform(partial.grid->transform().copy());
    hole.domain = inside;
    stampLevelSet(hole);
    return hole;
}

// The hole in the partial's own voxels.
openvdb::FloatGrid::Ptr inVoxelsOf(const openvdb::FloatGrid& partial, const LevelSet& hole) {
    if (hole.grid->transform() == partial.transform()) return hole.grid;
    auto moved = openvdb::FloatGrid::create(hole.grid->background());
    moved->setTransform(partial.transform().copy());
    openvdb::tools::resampleToMatch<openvdb::tools::BoxSampler>(*hole.grid, *moved);
    return moved;
}

// Everything that is known before the filling, over one box of the partial's voxels.
struct Surroundings {
    IndexBox box;
    CutFaces cut{};
    BrickField known, hole, open;  // distances [voxels], distances to the hole, 1 where a sample says nothing
};

// A distance may be trusted if what it is the distance to lies outside the hole.
bool trusted(float distance, float fromHole) {
    return fromHole >= 0 && std::abs(distance) <= fromHole + kTrust;
}

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
    around.known = widenBand(*partial.grid, box, around.cut, kBand, ctx);
    around.hole = widenBand(hole, box, {}, kBand, ctx);
    return around;
}

// 1 where a sample says nothing: in the hole, and where its distance may mean what is in there. With a guess
// only in the hole, since distances to the guess are as good as it is.
void markOpen(Surroundings& around, bool guessed, const RunContext& ctx) {
    around.open = BrickField::generate(around.known.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float known[BrickField::kSamples], fromHole[BrickField::kSamples];
        around.known.readBox(brick.min, brick.size(), known);
        around.hole.readBox(brick.min, brick.size(), fromHole);
        for (int i = 0; i < BrickField::kSamples; ++i) {
            const bool says =
                guessed ? fromHole[i] >= 0 : trusted(known[i], fromHole[i]) || fromHole[i] >= kBand;
            samples[i] = says ? 0.f : 1.f;
        }
    });
}

// True if what closed the partial left solid and void in the hole: a shape that is worth something as a
// guess.
bool hasBothSides(const Surroundings& around, const RunContext& ctx) {
    const IndexBox box = around.known.box();
    std::vector<std::array<std::size_t, 2>> planes(std::size_t(box.size().x), {0, 0});
    parallelFor(ctx, planes.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t x = begin; x < end; ++x)
            for (int y = 0; y <= box.max.y; ++y)
                for (int z = 0; z <= box.max.z; ++z)
                    if (around.hole.inside({int(x), y, z}) < -1)
                        ++planes[x][around.known.inside({int(x), y, z}) < 0 ? 0 : 1];
    });
    std::size_t solid = 0, empty = 0;
    for (const auto& plane : planes) {
        solid += plane[0];
        empty += plane[1];
    }
    return std::min(solid, empty) > (solid + empty) / 20;
}

// The filled hole; around it what was there, with distances that no longer mean what is gone.
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
    for (int x = box.min.x; x <= box.max.x; ++x)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int z = box.min.z; z <= box.max.z; ++z) {
                const openvdb::Coord c(x, y, z);
                if (distance.getValue(c) >= reach) continue;
                float value;
                if (from.probeValue(c, value))
                    to.setValueOn(c, value);
                else
                    to.setValueOff(c, value);
            }
    result->pruneGrid();
    return result;
}

IndexBox atLeast(IndexBox box, int side) {
    for (int axis = 0; axis < 3; ++axis) {
        const int missing = std::max(0, side - box.size()[axis]);
        box.min[axis] -= missing / 2;
        box.max[axis] += missing - missing / 2;
    }
    return box;
}

// The band inside the hole, and what was copied there.
std::vector<MappedVoxel> copiedVoxels(const SourceMap& map, const openvdb::FloatGrid& result,
                                      const openvdb::FloatGrid& hole) {
    std::vector<MappedVoxel> voxels;
    const auto distance = hole.getConstAccessor();
    for (auto it = result.cbeginValueOn(); it; ++it) {
        const Index3 voxel = fromCoord(it.getCoord());
        if (map.targetBox.contains(voxel) && distance.getValue(it.getCoord()) < 0)
            voxels.push_back({voxel, strongestSource(map, voxel)});
    }
    return voxels;
}

std::vector<GridPtr> sourceGrids(const std::vector<MappedVoxel>& voxels, const SourceMap& map,
                                 const openvdb::FloatGrid& result) {
    auto source = openvdb::Vec3IGrid::create(openvdb::Vec3i(0));
    source->setName("source");
    auto exemplar = openvdb::Int32Grid::create(0);
    exemplar->setName("exemplar");
    for (const GridPtr& grid : {GridPtr(source), GridPtr(exemplar)}) {
        grid->setTransform(result.transform().copy());
        grid->insertMeta("vdbsynth:map:exemplar_hash", openvdb::StringMetadata(map.exemplars.front().hash));
    }
    for (const MappedVoxel& voxel : voxels) {
        const Index3& from = voxel.from.voxel;
        source->tree().setValueOn(toCoord(voxel.to), openvdb::Vec3i(from.x, from.y, from.z));
        exemplar->tree().setValueOn(toCoord(voxel.to), 0);
    }
    return {source, exemplar};
}

// The mesh that a model was made from, in its voxels.
Mesh inVoxels(const Mesh& source, const openvdb::math::Transform& transform) {
    Mesh mesh = source;
    for (Vec3f& p : mesh.points) {
        const openvdb::Vec3d q =
            transform.worldToIndex(openvdb::Vec3d(double(p.x), double(p.y), double(p.z)));
        p = {float(q.x()), float(q.y()), float(q.z())};
    }
    return mesh;
}

// Places of a model's surface that are no face of the mesh it was made from: the sheets that closed it.
std::vector<Vec3f> closingSheets(const LevelSet& partial, const RunContext& ctx) {
    const Mesh mesh = inVoxels(*partial.source, partial.grid->transform());
    const IndexBox box = partial.domain.expanded(4);
    const BrickField distance = meshDistance(mesh, box, kHalfWidth, ctx);
    std::vector<Vec3f> sheets;
    for (const Vec3f& p : zeroLevelInIndexSpace(*partial.grid, 0, ctx).points)
        if (distance.at({int(std::lround(p.x)), int(std::lround(p.y)), int(std::lround(p.z))}) > kOffTheMesh)
            sheets.push_back(p);
    return sheets;
}

}  // namespace

LevelSet boxHole(const LevelSet& partial, const IndexBox& box, const RunContext& ctx) {
    requireModel(&partial, "the partial model", ctx);
    requireBox(box, "box");
    return holeFrom(partial, box, ctx, [&](const Index3& p) {
        float outside = 0, inside = -1e9f;
        for (int axis = 0; axis < 3; ++axis) {
            const float beyond =
                std::max(float(box.min[axis] - p[axis]), float(p[axis] - box.max[axis])) - 0.5f;
            outside += std::max(beyond, 0.f) * std::max(beyond, 0.f);
            inside = std::max(inside, beyond);
        }
        return outside > 0 ? std::sqrt(outside) : inside;
    });
}

LevelSet holesAtOpenEdges(const LevelSet& partial, const RunContext& ctx) {
    requireModel(&partial, "the partial model", ctx);
    if (!partial.source)
        throw Error(ErrorCode::Unusable,
                    "`hole`: needs a mesh, whose open edges say where the holes are; give a model or a box");
    Mesh welded = *partial.source;
    weldVertices(welded);
    if (summarize(welded).openEdges == 0)
        throw Error(ErrorCode::Unusable, "`hole`: the mesh has no open edges, so no holes");
    const std::vector<Vec3f> sheets = closingSheets(partial, ctx);
    if (sheets.empty())
        throw Error(ErrorCode::Unusable,
                    "`hole`: all holes of the mesh are smaller than two voxels and closed "
                    "already; use smaller voxels to fill them");
    IndexBox box;
    for (const Vec3f& p : sheets)
        for (int axis = 0; axis < 3; ++axis) {
            const int low = int(std::floor(p[axis] - kAroundSheet)),
                      high = int(std::ceil(p[axis] + kAroundSheet));
            const bool first = &p == &sheets.front();
            box.min[axis] = first ? low : std::min(box.min[axis], low);
            box.max[axis] = first ? high : std::max(box.max[axis], high);
        }
    const PointNeighbours neighbours(sheets);
    return holeFrom(partial, box, ctx, [&](const Index3& p) {
        std::uint32_t number;
        float squared;
        neighbours.nearest({float(p.x), float(p.y), float(p.z)}, 1, &number, &squared);
        return std::sqrt(squared) - kAroundSheet;
    });
}

namespace {

FillResult filledHoles(const LevelSet& partial, const LevelSet& hole, const LevelSet* exemplar,
                       const FillOptions& options, const RunContext& ctx) {
    const openvdb::FloatGrid::Ptr holeGrid = inVoxelsOf(*partial.grid, hole);
    const IndexBox holeBox = solidBox(*holeGrid, "the hole");
    const LevelSet& from = exemplar ? *exemplar : partial;
    const IndexBox fromBox = from.domain.expanded(from.domainRecorded ? 0 : int(kBand));
    const int block = options.block > 0 ? options.block : 16;
    const IndexBox box = atLeast(holeBox.expanded(int(kBand) + block), 4 * block);
    if (double(fromBox.volume()) > kMostVoxels)
        throw Error(ErrorCode::Unusable,
                    "the exemplar's box of " + boxText(fromBox) + " is too large to fill from; crop it");
    requireMemory(ctx, double(fromBox.volume()) * 6 + double(box.volume()) * 24, "filling the hole",
                  "crop the model, or use larger voxels");
    Stage stage(ctx, "what is known around the hole", 1);
    Surroundings around = surroundingsOf(partial, *holeGrid, box, ctx);
    BlockSynthesisOptions synthesis;
    synthesis.size = around.box.size();
    synthesis.block = options.block;
    synthesis.levels = options.levels;
    synthesis.known = &around.known;
    synthesis.open = &around.open;
    // A guess has the large shape; coarse passes would only put something else there.
    synthesis.guessed = hasBothSides(around, ctx);
    if (synthesis.guessed && options.levels == 0) synthesis.levels = 1;
    if (synthesis.guessed && options.block == 0) synthesis.block = kGuessedBlock;
    markOpen(around, synthesis.guessed, ctx);
    std::shared_ptr<const BrickField> field;
    BrickField mask;
    if (exemplar) {
        field = std::make_shared<const BrickField>(
            widenBand(*from.grid, fromBox, from.domainRecorded ? kAllCut : CutFaces{}, kBand, ctx));
    } else {
        Surroundings all = surroundingsOf(partial, *holeGrid, fromBox, ctx);
        markOpen(all, synthesis.guessed, ctx);
        mask = BrickField::generate(all.open.box(), ctx, [&](const IndexBox& brick, float* samples) {
            all.open.readBox(brick.min, brick.size(), samples);
            for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = 1 - samples[i];
        });
        synthesis.masks = {&mask};
        field = std::make_shared<const BrickField>(all.known);
    }
    stage.advance();
    BlockSynthesisResult filled = optimizeTexture({field}, synthesis, ctx);
    const FloatGridPtr rebuilt =
        closeAndRebuild(joined(around, filled.field, ctx), around.box.min, around.cut, kHalfWidth,
                        *partial.grid, "the filled model", ctx);
    FillResult result;
    result.model = partial;
    result.model.grid = replacedAround(*partial.grid, *holeGrid, holeBox, *rebuilt);
    result.stats = filled.stats;
    SourceMap map;
    map.patches = std::move(filled.map);
    map.targetBox = map.targetDomain = around.box;
    map.exemplars = {{fromBox, from.domain, levelSetHash(*from.grid)}};
    const std::vector<MappedVoxel> copied = copiedVoxels(map, *result.model.grid, *holeGrid);
    result.sources = sourceGrids(copied, map, *result.model.grid);
    std::vector<GridPtr> kept;
    for (const GridPtr& grid : partial.carried)
        if (!isOfSourceMap(grid->getName())) kept.push_back(grid->deepCopyGrid());
    result.model.carried = carryToVoxels(copied, {&from}, *result.model.grid, std::move(kept), ctx);
    if (!partial.domainRecorded) result.model.domain = solidBox(*result.model.grid, "the filled model");
    stampLevelSet(result.model);
    return result;
}

}  // namespace

void validate(const FillOptions& options, const LevelSet& partial, const LevelSet& hole,
              const LevelSet* exemplar) {
    requireOption(options.block == 0 || (options.block >= 4 && options.block <= 256), "block",
                  std::to_string(options.block), "a whole number from 4 to 256");
    requireOption(options.levels >= 0 && options.levels <= 8, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 8");
    requireModel(&partial, "the partial model");
    requireModel(&hole, "the hole");
    if (!exemplar) return;
    requireModel(exemplar, "the exemplar");
    const double voxel = voxelSizeOf(*exemplar->grid), own = voxelSizeOf(*partial.grid);
    if (std::abs(voxel - own) > 1e-4 * own)
        throw Error(ErrorCode::ShapeMismatch, "the exemplar's voxel size " + roundedText(voxel, 6) +
                                                  " is not the partial model's " + roundedText(own, 6) +
                                                  "; convert it with `voxelSize` " + roundedText(own, 6));
}

FillResult fillHoles(const LevelSet& partial, const LevelSet& hole, const LevelSet* exemplar,
                     const FillOptions& options, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        validate(options, partial, hole, exemplar);
        return filledHoles(partial, hole, exemplar, options, ctx);
    });
}

}  // namespace vdbsynth
