#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/mesh_distance.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/zero_level.h"

namespace vdbsynth {
namespace {

constexpr Index3 kBrickSize{BrickField::kSide, BrickField::kSide, BrickField::kSide};

// Voxels within `reach` of a mesh in index space.
IndexBox boxAround(const Mesh& mesh, int reach) {
    IndexBox box{{1 << 28, 1 << 28, 1 << 28}, {-(1 << 28), -(1 << 28), -(1 << 28)}};
    for (const Vec3f& p : mesh.points)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], int(std::floor(p[axis])));
            box.max[axis] = std::max(box.max[axis], int(std::ceil(p[axis])));
        }
    return box.expanded(reach);
}

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

}  // namespace

FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx) {
    Stage stage(ctx, "rebuilding the narrow band", 2);
    const Mesh mesh = zeroLevelInIndexSpace(field, 0, ctx);
    if (mesh.faceCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    stage.advance();
    const IndexBox box = boxAround(mesh, int(std::ceil(halfWidth)) + 1);
    const BrickField distance = meshDistance(mesh, box, halfWidth, ctx);
    const BrickField sign = gatherBricks(field, box, float(1 / voxelSizeOf(field)), kHalfWidth, ctx);
    const BrickField values = withSigns(distance, box.min, sign, {0, 0, 0}, box.size(), ctx);
    const FloatGridPtr grid = scatterBricks(values, box.min, float(voxelSizeOf(field)), halfWidth, ctx);
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
        narrow.readBox(brick.min, kBrickSize, samples);
    });
    const Mesh mesh = zeroLevelInIndexSpace(*scatterBricks(open, known.min, 1.f, kHalfWidth, ctx), 0, ctx);
    const BrickField distance = meshDistance(mesh, domain, halfWidth, ctx);
    return withSigns(distance, domain.min, narrow, domain.min - known.min, domain.size(), ctx);
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
    const BrickField closed = closeField(field, field.box(), cut, limit, ctx);
    FloatGridPtr grid = scatterBricks(closed, corner, float(voxelSizeOf(like)), limit, ctx);
    grid->setTransform(like.transform().copy());
    return rebuildLevelSet(*grid, halfWidth, what, ctx);
}

}  // namespace vdbsynth
