#include "libvdbsynth/pipeline/fill/fill.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/pipeline/fill/fill_steps.h"
#include "libvdbsynth/synth/texture_optimization.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/redistance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kOffTheMesh = 1.5f;  // [voxels] beyond which a position is not on a face of the mesh
constexpr int kGuessedBlock = 8;  // [voxels] small, since a damaged model has more whole patches of that size
constexpr float kAroundSheet = 3.f;  // [voxels] radius of the balls around a sheet that closed a hole
constexpr double kMostVoxels = 4e9;

LevelSet holeFrom(const LevelSet& partial, const IndexBox& inside, const RunContext& ctx,
                  const std::function<float(const Index3&)>& distance) {
    const IndexBox box = inside.expanded(5);
    requireMemory(ctx, double(box.volume()) * 0.5, "the hole", "use a smaller one");
    const BrickField field = BrickField::fromVoxels(
        IndexBox::fromSize(box.size()), ctx,
        [&](const Index3& p) { return std::clamp(distance(box.min + p), -kHalfWidth, kHalfWidth); });
    LevelSet hole;
    hole.grid = scatterBricks(field, box.min, float(voxelSizeOf(*partial.grid)), kHalfWidth, ctx);
    hole.grid->setTransform(partial.grid->transform().copy());
    hole.domain = inside;
    stampLevelSet(hole);
    return hole;
}

// The hole in the partial's own voxels.
openvdb::FloatGrid::Ptr inVoxelsOf(const openvdb::FloatGrid& partial, const LevelSet& hole,
                                   const RunContext& ctx) {
    const bool wide = halfWidthOf(*hole.grid) >= double(kHalfWidth) - 1e-3;
    if (wide && hole.grid->transform() == partial.transform()) return hole.grid;
    return resampleLevelSet(*hole.grid, partial, kHalfWidth, "the hole", ctx);
}

// True if the partial's closure left solid and void in the hole: a shape that is useful as a guess.
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

IndexBox atLeast(IndexBox box, int side) {
    for (int axis = 0; axis < 3; ++axis) {
        const int missing = std::max(0, side - box.size()[axis]);
        box.min[axis] -= missing / 2;
        box.max[axis] += missing - missing / 2;
    }
    return box;
}

// A hole in the form of a map.
MappedHole holeOf(const openvdb::FloatGrid& hole, const RunContext& ctx) {
    const IndexBox box = solidBox(hole, "the hole").expanded(int(kHalfWidth) + 2);
    requireMemory(ctx, double(box.volume()) * 4, "the hole", "use a smaller one");
    MappedHole mapped;
    mapped.corner = box.min;
    mapped.distance = gatherBricks(hole, box, float(1 / voxelSizeOf(hole)), kHalfWidth, ctx);
    return mapped;
}

// The source mesh of a model, in its voxels.
Mesh inVoxels(const Mesh& source, const openvdb::math::Transform& transform) {
    Mesh mesh = source;
    mesh.origin = {0, 0, 0};
    for (Vec3f& p : mesh.points) {
        const openvdb::Vec3d q = transform.worldToIndex(toVec(cast<double>(p) + source.origin));
        p = {float(q.x()), float(q.y()), float(q.z())};
    }
    return mesh;
}

// Positions of a model's surface that are on no face of its source mesh: the sheets that closed it.
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
                    "`hole`: needs a mesh, whose open edges mark the holes; give a model or a box");
    Mesh welded = *partial.source;
    weldVertices(welded);
    if (summarize(welded).openEdges == 0)
        throw Error(ErrorCode::Unusable, "`hole`: the mesh has no open edges, so no holes");
    const std::vector<Vec3f> sheets = closingSheets(partial, ctx);
    if (sheets.empty())
        throw Error(ErrorCode::Unusable,
                    "`hole`: all holes of the mesh are smaller than two voxels and closed already; use "
                    "smaller voxels to fill them");
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
    SourceMap map;
    map.method = MapMethod::Fill;
    map.hole = holeOf(*inVoxelsOf(*partial.grid, hole, ctx), ctx);
    map.hole.fromSelf = exemplar == nullptr;
    // As the map's reader provides it, so that a repetition has the same input.
    const FloatGridPtr holeGrid = holeGridOf(map.hole, *partial.grid, ctx);
    const IndexBox holeBox = solidBox(*holeGrid, "the hole");
    const LevelSet& from = exemplar ? *exemplar : partial;
    const IndexBox fromBox = from.domain.expanded(from.domainRecorded ? 0 : int(kFillBand));
    const int block = options.block > 0 ? options.block : 16;
    const IndexBox box = atLeast(holeBox.expanded(int(kFillBand) + block), 4 * block);
    if (double(fromBox.volume()) > kMostVoxels)
        throw Error(ErrorCode::Unusable,
                    "the exemplar's box of " + boxText(fromBox) + " is too large to fill from; crop it");
    requireMemory(ctx, double(fromBox.volume()) * 6 + double(box.volume()) * 24, "filling the hole",
                  "crop the model, or use larger voxels");
    Stage stage(ctx, "surroundings of the hole", 1);
    Surroundings around = surroundingsOf(partial, *holeGrid, box, ctx);
    BlockSynthesisOptions synthesis;
    synthesis.size = around.box.size();
    synthesis.block = options.block;
    synthesis.levels = options.levels;
    synthesis.known = &around.known;
    synthesis.open = &around.open;
    // A guess has the large shape; coarse passes would only replace it by something else.
    synthesis.guessed = hasBothSides(around, ctx);
    if (synthesis.guessed && options.levels == 0) synthesis.levels = 1;
    if (synthesis.guessed && options.block == 0) synthesis.block = kGuessedBlock;
    markOpen(around, synthesis.guessed, ctx);
    SelfExemplar self;
    BrickField field;
    MappedExemplar mapped{fromBox, from.domain, levelSetHash(*from.grid), {}, transformOf(*from.grid)};
    if (exemplar) {
        mapped.cut = from.domainRecorded ? kAllCut : CutFaces{};
        field = fillExemplar(from, fromBox, mapped.cut, ctx);
    } else {
        self = selfExemplar(partial, *holeGrid, fromBox, synthesis.guessed, ctx);
        synthesis.masks = {&self.mask};
        field = std::move(self.field);
        mapped.box = self.box;
    }
    map.exemplars = {mapped};
    stage.advance();
    BlockSynthesisResult filled =
        optimizeTexture({std::make_shared<const BrickField>(std::move(field))}, synthesis, ctx);
    map.hole.guessed = synthesis.guessed;
    map.patches = std::move(filled.map);
    map.matched = filled.stats.block;
    map.targetBox = map.targetDomain = around.box;
    map.cut = around.cut;
    map.band = kFillBand;
    map.voxelSize = voxelSizeOf(*from.grid);
    map.target = {levelSetHash(*partial.grid), voxelSizeOf(*partial.grid), partial.domainRecorded};
    FillResult result;
    result.stats = filled.stats;
    result.model = fillThroughMap(map, around, filled.field, partial, *holeGrid, from, ctx);
    result.map = std::move(map);
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
    validate(options, partial, hole, exemplar);
    return withThreads(ctx, [&] { return filledHoles(partial, hole, exemplar, options, ctx); });
}

}  // namespace vdbsynth
