#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/mesh_distance.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/wall.h"
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
    return withSigns(distance, narrow.domain.min, narrow.field, narrow.domain.min, domain.size(), ctx);
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
    const BrickField closed = closeField(field, field.box(), cut, limit, ctx);
    FloatGridPtr grid = scatterBricks(closed, corner, float(voxelSizeOf(like)), limit, ctx);
    grid->setTransform(like.transform().copy());
    return rebuildLevelSet(*grid, halfWidth, what, ctx);
}

namespace {

// A value over the length of its gradient towards the zero level, by the upwind differences of the eikonal
// equation [rouy1992]: those to the neighbours that are nearer to it. At most one voxel more than the nearest
// neighbour's, as a distance is. `value` points into an array of these strides.
float normalizedValue(const float* value, const std::ptrdiff_t (&stride)[3]) {
    const float sign = *value < 0 ? -1.f : 1.f;
    float squared = 0, nearest = std::abs(*value);
    for (std::ptrdiff_t step : stride) {
        const float near = std::max(0.f, std::min(sign * value[-step], sign * value[step]));
        const float drop = std::max({0.f, sign * (*value - value[-step]), sign * (*value - value[step])});
        nearest = std::min(nearest, near);
        squared += drop * drop;
    }
    return sign * std::min(std::abs(*value) / std::clamp(std::sqrt(squared), 0.25f, 4.f), nearest + 1);
}

// The most that a distance can be beside its six neighbours: a voxel more than one of the same side, a voxel
// beside the other side. Holds every distance; a seam between two copies may break it.
float longestBeside(const float* value, const std::ptrdiff_t (&stride)[3]) {
    float longest = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        for (const std::ptrdiff_t step : {-stride[axis], stride[axis]}) {
            const float other = value[step];
            longest = std::min(longest, (other < 0) == (*value < 0) ? std::abs(other) + 1 : 1.f);
        }
    return longest;
}

// A field whose every sample is made anew from itself and the six around it.
template <typename Change>
BrickField changedLocally(const BrickField& field, const RunContext& ctx, const Change& change) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int kPadded = BrickField::kSide + 2;
        constexpr std::ptrdiff_t kStride[3] = {kPadded * kPadded, kPadded, 1};
        float padded[kPadded * kPadded * kPadded];
        field.readBox(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        for (int x = 1; x <= BrickField::kSide; ++x)
            for (int y = 1; y <= BrickField::kSide; ++y)
                for (int z = 1; z <= BrickField::kSide; ++z)
                    *samples++ = change(padded + (x * kPadded + y) * kPadded + z, kStride);
    });
}

// Each value over the length of its gradient: a distance to first order, exact where the field is one.
BrickField normalized(const BrickField& field, float limit, const RunContext& ctx) {
    return changedLocally(field, ctx, [limit](const float* value, const std::ptrdiff_t(&stride)[3]) {
        return std::abs(*value) >= limit ? *value : std::clamp(normalizedValue(value, stride), -limit, limit);
    });
}

// No value longer than its neighbours allow, so that every voxel beside the surface has all of its neighbours
// in the band.
BrickField shortened(const BrickField& field, float limit, const RunContext& ctx) {
    return changedLocally(field, ctx, [limit](const float* value, const std::ptrdiff_t(&stride)[3]) {
        const float most = std::min(limit, longestBeside(value, stride));
        return std::clamp(*value, -most, most);
    });
}

}  // namespace

FloatGridPtr closeAndNormalize(const BrickField& field, const Index3& corner, const CutFaces& cut,
                               const openvdb::FloatGrid& like, const std::string& what,
                               const RunContext& ctx) {
    Stage stage(ctx, "normalising the narrow band", 1);
    BrickField closed = closeField(field, field.box(), cut, kHalfWidth, ctx);
    for (int pass = 0; pass < 2; ++pass) closed = normalized(closed, kHalfWidth, ctx);
    closed = shortened(closed, kHalfWidth, ctx);
    FloatGridPtr grid = scatterBricks(closed, corner, float(voxelSizeOf(like)), kHalfWidth, ctx);
    if (grid->activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    grid->setTransform(like.transform().copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    stage.advance();
    return grid;
}

BrickField gatherNarrowBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain,
                            const RunContext& ctx) {
    return gatherBricks(levelSet, domain, float(1 / voxelSizeOf(levelSet)), kHalfWidth, ctx);
}

}  // namespace vdbsynth
