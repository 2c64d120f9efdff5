#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/mesh_distance.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/wall.h"
#include "libvdbsynth/vdb/zero_level.h"

namespace vdbsynth {
namespace {

constexpr Index3 kBrickSize{BrickField::kSide, BrickField::kSide, BrickField::kSide};

// Distances with the signs of another field, both read at an offset; the result begins at 0.
BrickField withSigns(const BrickField& distance, const Index3& distanceOffset, const BrickField& sign,
                     const Index3& signOffset, const Index3& size, const RunContext& ctx) {
    return BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
        float signs[BrickField::kSamples];
        distance.readBox(brick.min + distanceOffset, kBrickSize, samples);
        sign.readBox(brick.min + signOffset, kBrickSize, signs);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = signs[i] < 0 ? -samples[i] : samples[i];
    });
}

constexpr float kKept = 0.2f;    // [voxels] by which a distance may be beside the mesh's and stay as it is
constexpr float kUneven = 0.3f;  // by which a gradient's length may be off 1 where distances stay

// True if the field is one of distances around a sample: its gradient, central or upwind, is about 1 long.
// `value` points into a padded brick.
bool isDistance(const float* value, const std::ptrdiff_t (&stride)[3]) {
    const float sign = *value < 0 ? -1.f : 1.f;
    float central = 0, upwind = 0;
    for (const std::ptrdiff_t step : stride) {
        const float across = (value[step] - value[-step]) / 2;
        const float drop = std::max({0.f, sign * (*value - value[-step]), sign * (*value - value[step])});
        central += across * across;
        upwind += drop * drop;
    }
    return std::min(std::abs(std::sqrt(central) - 1), std::abs(std::sqrt(upwind) - 1)) < kUneven;
}

// Distances to a mesh with the signs of the field that was meshed, both read at an offset; the result begins
// at 0. Where the field has good distances of its own they stay: a mesh of its zero level lies inside what is
// round, by a tenth of a voxel where it is as thin as three, and so do distances to it. Those further off
// than kKept are the mesh's, those between once and twice that go over from one to the other.
// @param band  [voxels] where the field's distances end
BrickField keepingDistances(const BrickField& toMesh, const Index3& meshOffset, const BrickField& field,
                            const Index3& fieldOffset, const Index3& size, float band,
                            const RunContext& ctx) {
    return BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int kPadded = BrickField::kSide + 2;
        constexpr std::ptrdiff_t kStride[3] = {kPadded * kPadded, kPadded, 1};
        float padded[kPadded * kPadded * kPadded];
        field.readBox(brick.min + fieldOffset - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        toMesh.readBox(brick.min + meshOffset, kBrickSize, samples);
        for (int x = 1; x <= BrickField::kSide; ++x)
            for (int y = 1; y <= BrickField::kSide; ++y)
                for (int z = 1; z <= BrickField::kSide; ++z, ++samples) {
                    const float* value = padded + (x * kPadded + y) * kPadded + z;
                    const float own = std::abs(*value), off = own - *samples;
                    if (std::abs(off) < 2 * kKept && own < band - 1 && isDistance(value, kStride))
                        *samples +=
                            std::abs(off) <= kKept ? off : std::copysign(2 * kKept - std::abs(off), off);
                    if (*value < 0) *samples = -*samples;
                }
    });
}

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

// A copy of the leaves that touch a box, and of what is constant there.
FloatGridPtr leavesAround(const openvdb::FloatGrid& grid, const IndexBox& box) {
    FloatGridPtr copy = openvdb::FloatGrid::create(grid.background());
    copy->setTransform(grid.transform().copy());
    const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
    for (int x = box.min.x & ~7; x <= box.max.x; x += 8)
        for (int y = box.min.y & ~7; y <= box.max.y; y += 8)
            for (int z = box.min.z & ~7; z <= box.max.z; z += 8) {
                const openvdb::Coord origin(x, y, z);
                if (const Leaf* leaf = accessor.probeConstLeaf(origin)) {
                    copy->tree().addLeaf(new Leaf(*leaf));
                    continue;
                }
                float value;
                const bool active = accessor.probeValue(origin, value);
                if (active || value != grid.background()) copy->tree().addTile(1, origin, value, active);
            }
    return copy;
}

// A large box in parts that are rebuilt on their own, with sides of whole leaves: meshes and distances of all
// of it at once take several times the memory of the result.
std::vector<IndexBox> partsOf(const IndexBox& box) {
    constexpr int kLongest = 224, kSide = 176;  // [voxels]
    IndexBox whole;
    Index3 side;
    for (int axis = 0; axis < 3; ++axis) {
        whole.min[axis] = box.min[axis] & ~7;
        const int length = (box.max[axis] | 7) + 1 - whole.min[axis];
        const int parts = length <= kLongest ? 1 : (length + kSide - 1) / kSide;
        side[axis] = ((length + parts - 1) / parts + 7) & ~7;
        whole.max[axis] = whole.min[axis] + length - 1;
    }
    std::vector<IndexBox> parts;
    for (int x = whole.min.x; x <= whole.max.x; x += side.x)
        for (int y = whole.min.y; y <= whole.max.y; y += side.y)
            for (int z = whole.min.z; z <= whole.max.z; z += side.z)
                parts.push_back(
                    IndexBox{{x, y, z}, Index3{x, y, z} + side - Index3{1, 1, 1}}.intersection(whole));
    return parts;
}

// The rebuilt level set inside a box, null where all of the field has one sign. The same bits whatever the
// box: faces that could be nearest to any of its voxels, and what they are found through, lie within the
// reach.
FloatGridPtr rebuiltPart(const openvdb::FloatGrid& field, const IndexBox& part, bool whole, float halfWidth,
                         bool distances, const RunContext& ctx) {
    const int rounds = int(std::ceil(halfWidth));
    const float voxel = float(voxelSizeOf(field));
    const Mesh mesh = whole ? zeroLevelInIndexSpace(field, 0, ctx)
                            : zeroLevelInIndexSpace(*leavesAround(field, part.expanded(rounds + 3)), 0, ctx);
    if (mesh.faceCount() == 0) {
        if (field.getConstAccessor().getValue(toCoord(part.min)) >= 0) return nullptr;
        return scatterBricks(BrickField(IndexBox::fromSize(part.size()), -halfWidth), part.min, voxel,
                             halfWidth, ctx);
    }
    const BrickField distance = meshDistance(mesh, part.expanded(rounds + 1), halfWidth, ctx);
    const BrickField own = gatherBricks(field, part.expanded(1), 1 / voxel, kHalfWidth, ctx);
    const BrickField values =
        distances ? keepingDistances(distance, part.min, own, {1, 1, 1}, part.size(), kHalfWidth, ctx)
                  : withSigns(distance, part.min, own, {1, 1, 1}, part.size(), ctx);
    return scatterBricks(values, part.min, voxel, halfWidth, ctx);
}

// Moves the leaves and constant regions of a part, which lies in whole leaves, into the result.
void take(openvdb::FloatGrid& from, openvdb::FloatGrid& to) {
    auto tile = from.tree().cbeginValueOff();
    tile.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (*tile < 0) to.tree().addTile(tile.getLevel(), tile.getCoord(), *tile, false);
    std::vector<Leaf*> leaves;
    from.tree().stealNodes(leaves, from.background(), false);
    for (Leaf* leaf : leaves) to.tree().addLeaf(leaf);
}

}  // namespace

namespace {

FloatGridPtr rebuilt(const openvdb::FloatGrid& field, float halfWidth, bool distances,
                     const std::string& what, const RunContext& ctx) {
    const openvdb::CoordBBox active = field.evalActiveVoxelBoundingBox();
    if (active.empty()) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    const int reach = int(std::ceil(halfWidth)) + 1;
    const std::vector<IndexBox> parts =
        partsOf(IndexBox{fromCoord(active.min()), fromCoord(active.max())}.expanded(reach));
    Stage stage(ctx, "rebuilding the narrow band", parts.size());
    const FloatGridPtr grid = openvdb::FloatGrid::create(halfWidth * float(voxelSizeOf(field)));
    constexpr std::size_t kBatch = 8;  // parts between two looks at the clock
    for (std::size_t first = 0; first < parts.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, parts.size() - first);
        std::vector<FloatGridPtr> made(count);
        parallelFor(ctx, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                made[i] = rebuiltPart(field, parts[first + i], parts.size() == 1, halfWidth, distances, ctx);
        });
        for (const FloatGridPtr& part : made)
            if (part) take(*part, *grid);
        stage.advance(count);
    }
    if (grid->activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    grid->setTransform(field.transform().copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    stage.advance();
    return grid;
}

}  // namespace

FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx) {
    return rebuilt(field, halfWidth, false, what, ctx);
}

namespace {

// The zero level of a field within the reach of a domain; beyond the field's box its last layer goes on.
Mesh zeroLevelAround(const BrickField& field, const IndexBox& domain, float halfWidth,
                     const RunContext& ctx) {
    const IndexBox around = domain.expanded(int(std::ceil(halfWidth)) + 2);
    const BrickField open = BrickField::generate(around, ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, kBrickSize, samples);
    });
    return zeroLevelInIndexSpace(*scatterBricks(open, {0, 0, 0}, 1.f, kHalfWidth, ctx), 0, ctx);
}

// A level set as it is over a domain and `reach` voxels around it, and where the domain begins in that.
// Beyond a cut face there is nothing: the caps of a clipped model do not count.
struct NarrowField {
    BrickField field;
    IndexBox domain;
};

NarrowField gatherNarrow(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                         int reach, const RunContext& ctx) {
    IndexBox known = domain;
    for (int axis = 0; axis < 3; ++axis) {
        if (!cut[std::size_t(2 * axis)]) known.min[axis] -= reach;
        if (!cut[std::size_t(2 * axis + 1)]) known.max[axis] += reach;
    }
    NarrowField narrow;
    narrow.field = gatherBricks(levelSet, known, float(1 / voxelSizeOf(levelSet)), kHalfWidth, ctx);
    narrow.domain = {domain.min - known.min, domain.max - known.min};
    return narrow;
}

}  // namespace

BrickField widenBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                     float halfWidth, const RunContext& ctx) {
    const NarrowField narrow = gatherNarrow(levelSet, domain, cut, int(std::ceil(halfWidth)) + 2, ctx);
    const Mesh mesh = zeroLevelAround(narrow.field, narrow.domain, halfWidth, ctx);
    const BrickField distance = meshDistance(mesh, narrow.domain, halfWidth, ctx);
    return keepingDistances(distance, narrow.domain.min, narrow.field, narrow.domain.min, domain.size(),
                            kHalfWidth, ctx);
}

BrickField widenBandCoarse(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                           float halfWidth, const RunContext& ctx) {
    const NarrowField narrow = gatherNarrow(levelSet, domain, cut, 2 * int(std::ceil(halfWidth)) + 4, ctx);
    Mesh mesh = zeroLevelAround(narrow.field, narrow.domain, 2 * halfWidth, ctx);
    // Coarse voxel i covers 2i and 2i + 1 of the domain. A thin bar's coarse mean is no distance; this is.
    for (Vec3f& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis) p[axis] = (p[axis] - float(narrow.domain.min[axis]) - 0.5f) / 2;
    const Index3 size = domain.size();
    const IndexBox box = IndexBox::fromSize({(size.x + 1) / 2, (size.y + 1) / 2, (size.z + 1) / 2});
    const BrickField distance = meshDistance(mesh, box, halfWidth, ctx);
    const BrickField inside =
        BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
            narrow.field.readBox(brick.min + narrow.domain.min, kBrickSize, samples);
        });
    return withSigns(distance, {0, 0, 0}, halved(inside, ctx), {0, 0, 0}, box.size(), ctx);
}

BrickField closeField(const BrickField& field, const IndexBox& domain, const CutFaces& cut, float limit,
                      const RunContext& ctx) {
    const int margin = int(std::ceil(limit));  // the whole band outside the caps
    return BrickField::generate(domain.expanded(margin), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, kBrickSize, samples);
        for (int x = brick.min.x; x <= brick.max.x; ++x)
            for (int y = brick.min.y; y <= brick.max.y; ++y)
                for (int z = brick.min.z; z <= brick.max.z; ++z, ++samples) {
                    const Index3 p{x, y, z};
                    float value = std::clamp(*samples, -limit, limit);
                    for (int axis = 0; axis < 3; ++axis) {
                        const float low = float(domain.min[axis] - p[axis]) - 0.5f,
                                    high = float(p[axis] - domain.max[axis]) - 0.5f;
                        if (cut[std::size_t(2 * axis)] || low > 0) value = std::max(value, low);
                        if (cut[std::size_t(2 * axis + 1)] || high > 0) value = std::max(value, high);
                    }
                    *samples = std::min(value, limit);
                }
    });
}

FloatGridPtr closeAndRebuild(const BrickField& field, const Index3& corner, const CutFaces& cut,
                             float halfWidth, const openvdb::FloatGrid& like, const std::string& what,
                             const RunContext& ctx) {
    const float limit = std::max(halfWidth, 3.f);
    BrickField closed = closeField(field, field.box(), cut, limit, ctx);
    FloatGridPtr grid = scatterBricks(closed, corner, float(voxelSizeOf(like)), limit, ctx);
    closed = BrickField();
    grid->setTransform(like.transform().copy());
    return rebuilt(*grid, halfWidth, true, what, ctx);
}

BrickField gatherNarrowBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain,
                            const RunContext& ctx) {
    return gatherBricks(levelSet, domain, float(1 / voxelSizeOf(levelSet)), kHalfWidth, ctx);
}

}  // namespace vdbsynth
