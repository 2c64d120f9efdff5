#include "libvdbsynth/vdb/redistance.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/interrupter.h"
#include "libvdbsynth/vdb/wall.h"
#include "libvdbsynth/vdb/zero_level.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

// Unsigned distances [voxels] in index space, active where below `halfWidth`.
openvdb::FloatGrid::Ptr unsignedDistance(const Mesh& mesh, float halfWidth, const RunContext& ctx) {
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.points.size());
    for (const Vec3f& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
    std::vector<openvdb::Vec3I> triangles;
    for (const Triangle& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    std::vector<openvdb::Vec4I> quads;
    for (const Quad& q : mesh.quads) quads.emplace_back(q[0], q[1], q[2], q[3]);
    const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    const ThreadLimit limit(ctx);
    openvdb::FloatGrid::Ptr grid = behindWall(ErrorCode::Unusable, "distance to the surface", [&] {
        Interrupter interrupter(ctx);
        return openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(
            static_cast<openvdb::util::NullInterrupter&>(interrupter), *transform, points, triangles, quads,
            halfWidth);
    });
    throwIfCancelled(ctx);
    return grid;
}

// Gives every stored voxel the sign of `field`, scales to world units and fills the rest.
void applySigns(openvdb::FloatGrid& distance, const openvdb::FloatGrid& field, float voxelSize,
                float halfWidth, const RunContext& ctx) {
    std::vector<Leaf*> leaves;
    distance.tree().getNodes(leaves);
    parallelFor(ctx, leaves.size(), 32, [&](std::size_t begin, std::size_t end) {
        const openvdb::FloatGrid::ConstAccessor sign = field.getConstAccessor();
        for (std::size_t i = begin; i < end; ++i)
            for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
                const float magnitude = leaves[i]->isValueOn(n) ? leaves[i]->getValue(n) : halfWidth;
                const bool inside = sign.getValue(leaves[i]->offsetToGlobalCoord(n)) < 0;
                leaves[i]->setValueOnly(n, (inside ? -magnitude : magnitude) * voxelSize);
            }
    });
    openvdb::tools::signedFloodFillWithValues(distance.tree(), halfWidth * voxelSize, -halfWidth * voxelSize);
}

}  // namespace

FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx) {
    Stage stage(ctx, "rebuilding the narrow band", 2);
    const Mesh mesh = zeroLevelInIndexSpace(field, 0, ctx);
    if (mesh.faceCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    stage.advance();
    openvdb::FloatGrid::Ptr grid = unsignedDistance(mesh, halfWidth, ctx);
    applySigns(*grid, field, float(voxelSizeOf(field)), halfWidth, ctx);
    grid->setTransform(field.transform().copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    stage.advance();
    return grid;
}

BrickField widenBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                     float halfWidth, const RunContext& ctx) {
    // What may matter: the domain and the band's reach around it. Beyond a cut face the last layer inside
    // goes on.
    const int reach = int(std::ceil(halfWidth)) + 2;
    IndexBox known = domain;
    for (int axis = 0; axis < 3; ++axis) {
        if (!cut[std::size_t(2 * axis)]) known.min[axis] -= reach;
        if (!cut[std::size_t(2 * axis + 1)]) known.max[axis] += reach;
    }
    const BrickField narrow =
        gatherBricks(levelSet, known, float(1 / voxelSizeOf(levelSet)), kHalfWidth, ctx);
    const IndexBox around{domain.min - known.min - Index3{reach, reach, reach},
                          domain.max - known.min + Index3{reach, reach, reach}};
    const BrickField open = BrickField::generate(around, ctx, [&](const IndexBox& brick, float* samples) {
        narrow.readBox(brick.min, {BrickField::kSide, BrickField::kSide, BrickField::kSide}, samples);
    });
    const Mesh mesh = zeroLevelInIndexSpace(*scatterBricks(open, known.min, 1.f, kHalfWidth, ctx), 0, ctx);
    BrickField distance(IndexBox::fromSize(domain.size()), halfWidth);
    if (mesh.faceCount() > 0)
        distance = gatherBricks(*unsignedDistance(mesh, halfWidth, ctx), domain, 1.f, halfWidth, ctx);
    const Index3 shift = domain.min - known.min;
    return BrickField::generate(distance.box(), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr Index3 side{BrickField::kSide, BrickField::kSide, BrickField::kSide};
        float signs[BrickField::kSamples];
        distance.readBox(brick.min, side, samples);
        narrow.readBox(brick.min + shift, side, signs);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = signs[i] < 0 ? -samples[i] : samples[i];
    });
}

BrickField closeField(const BrickField& field, const IndexBox& domain, const CutFaces& cut, float limit,
                      const RunContext& ctx) {
    constexpr int kMargin = 2;
    return BrickField::generate(domain.expanded(kMargin), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, {BrickField::kSide, BrickField::kSide, BrickField::kSide}, samples);
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
    const BrickField closed = closeField(field, field.box(), cut, limit, ctx);
    FloatGridPtr grid = scatterBricks(closed, corner, float(voxelSizeOf(like)), limit, ctx);
    grid->setTransform(like.transform().copy());
    return rebuildLevelSet(*grid, halfWidth, what, ctx);
}

}  // namespace vdbsynth
