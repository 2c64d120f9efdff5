#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbsynth {

class BrickField;

/// A level set laid out for rays: bricks of 8^3 cells with the samples around them, 16 bits each, a table
/// that says of every other brick how many empty ones lie around it, and distances to the surface everywhere,
/// on every few voxels. Lengths are voxels, places count from the corner of `voxels()`. Reads are safe from
/// many threads at once.
class TracedSurface {
public:
    /// @throw Error EmptyInput (no inside), Memory, Cancelled
    /// @par Cost    1.5 kB per brick of the band; distances: O(voxels near the surface + up to a million)
    /// @par Repeats same bits for any number of threads
    explicit TracedSurface(const openvdb::FloatGrid& grid, const RunContext& ctx = {});

    /// The part of index space that is laid out.
    const IndexBox& voxels() const { return mVoxels; }
    /// From places here to the world, and a direction of the world as one here, of its length in voxels.
    const Affine& toWorld() const { return mToWorld; }
    Vec3d placeHere(const Vec3d& world) const;
    Vec3d directionHere(const Vec3d& world) const;
    /// [world] places that the surface does not reach beyond by more than a voxel, for framing.
    std::vector<Vec3d> outline() const;
    /// The least of dot(place, axis) over the solid [voxels], to a few hundredths of a voxel where the
    /// distances are exact. @param axis  unit vector
    double lowest(const Vec3d& axis) const;

    /// The first place where a ray enters the solid. Where trilinear distances of two samples differ in sign
    /// it is found to a hundredth of a voxel; parts thinner than about half a voxel may be missed.
    /// @param direction  of unit length
    /// @param along      set to the distance from `origin`
    bool meets(const Vec3f& origin, const Vec3f& direction, float& along) const;
    /// Trilinear distance, clamped to the band, negative inside.
    float bandDistance(const Vec3f& p) const;
    /// Distance to the surface at any place: exact in the band, within a sample's
    /// diagonal (coarseness() * 1.8) elsewhere in the voxels, a lower bound outside of them, never negative.
    float farDistance(const Vec3f& p) const;
    int coarseness() const { return mCoarseness; }
    /// Unit normal: central differences of trilinear distances over three quarters of a voxel, which are
    /// continuous, where the gradient of a trilinear cell is not.
    Vec3f normalAt(const Vec3f& p) const;
    /// Half of the diagonal of the solid's box [voxels].
    float reach() const { return mReach; }
    Vec3f middle() const { return mMiddle; }

private:
    static constexpr int kStride = 9, kBrickSamples = kStride * kStride * kStride;
    static constexpr std::int32_t kAllOutside = -1, kAllInside = -2;  // of slots
    void layOut(const BrickField& field, const RunContext& ctx);
    void measureEmptiness();
    float coarseAt(const Vec3f& p) const;
    // Trilinear in a cell of the brick with this slot.
    float sampleIn(std::int32_t slot, const Index3& cell, const Vec3f& p) const;
    bool isBeyond(const Vec3f& p) const {
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] < 0 || p[axis] > mLast[axis]) return true;
        return false;
    }

    IndexBox mVoxels, mSolid;
    Affine mToWorld{};
    Vec3d mAxes[3];  // of index space, in the world
    double mVoxelSize = 1;
    Index3 mBricks;                      // along each axis
    std::vector<std::int32_t> mSlots;    // per brick: where its samples are; -1: all outside, -2: all inside
    std::vector<std::uint8_t> mEmpty;    // per brick without samples: bricks to the nearest that has some
    std::vector<std::int16_t> mSamples;  // 9^3 a brick
    float mLimit = 3, mScale = 1;        // of the samples
    int mCoarseness = 2;
    Index3 mFarSize;
    std::vector<float> mFar;
    float mReach = 0;
    Vec3f mMiddle, mLast;  // mLast: the last voxel's place
};

// Inline, as millions of rays ask many times each.
inline float TracedSurface::bandDistance(const Vec3f& p) const {
    // The processors that everything runs on have no instruction for std::floor.
    const auto below = [](float v) { return int(v) - (v < float(int(v)) ? 1 : 0); };
    const int x = below(p.x), y = below(p.y), z = below(p.z);
    const int bx = x >> 3, by = y >> 3, bz = z >> 3;
    if (bx < 0 || by < 0 || bz < 0 || bx >= mBricks.x || by >= mBricks.y || bz >= mBricks.z) return mLimit;
    const std::int32_t slot = mSlots[latticeIndex({bx, by, bz}, mBricks)];
    if (slot < 0) return slot == kAllInside ? -mLimit : mLimit;
    return sampleIn(slot, {x, y, z}, p);
}

inline float TracedSurface::sampleIn(std::int32_t slot, const Index3& cell, const Vec3f& p) const {
    const std::int16_t* s = mSamples.data() + std::size_t(slot) * kBrickSamples +
                            ((cell.x & 7) * kStride + (cell.y & 7)) * kStride + (cell.z & 7);
    const float fx = p.x - float(cell.x), fy = p.y - float(cell.y), fz = p.z - float(cell.z);
    const auto along = [fz](const std::int16_t* q) { return float(q[0]) + (float(q[1]) - float(q[0])) * fz; };
    constexpr int kY = kStride, kX = kStride * kStride;
    const float low = along(s) + (along(s + kY) - along(s)) * fy;
    const float high = along(s + kX) + (along(s + kX + kY) - along(s + kX)) * fy;
    return (low + (high - low) * fx) * mScale;
}

inline float TracedSurface::coarseAt(const Vec3f& p) const {
    Vec3f q = (p - Vec3f{1, 1, 1} * (0.5f * float(mCoarseness - 1))) * (1 / float(mCoarseness));
    Index3 base;
    for (int axis = 0; axis < 3; ++axis) {
        q[axis] = std::clamp(q[axis], 0.f, float(mFarSize[axis] - 1));
        base[axis] = std::min(int(q[axis]), std::max(0, mFarSize[axis] - 2));
    }
    const Index3 next{mFarSize.x > 1, mFarSize.y > 1, mFarSize.z > 1};
    const float fx = q.x - float(base.x), fy = q.y - float(base.y), fz = q.z - float(base.z);
    const std::size_t kY = std::size_t(mFarSize.z) * std::size_t(next.y);
    const std::size_t kX = std::size_t(mFarSize.y) * std::size_t(mFarSize.z) * std::size_t(next.x);
    const float* s = mFar.data() + latticeIndex(base, mFarSize);
    const auto along = [&](const float* r) { return r[0] + (r[next.z] - r[0]) * fz; };
    const float low = along(s) + (along(s + kY) - along(s)) * fy;
    const float high = along(s + kX) + (along(s + kX + kY) - along(s + kX)) * fy;
    return low + (high - low) * fx;
}

inline float TracedSurface::farDistance(const Vec3f& p) const {
    if (isBeyond(p)) {
        // Seen from the nearest place of the box, which is convex, the surface and p are at least a right
        // angle apart.
        Vec3f inside;
        for (int axis = 0; axis < 3; ++axis) inside[axis] = std::clamp(p[axis], 0.f, mLast[axis]);
        const Vec3f apart = p - inside;
        const float there = coarseAt(inside);
        return std::sqrt(there * there + dot(apart, apart));
    }
    // Most rays ask next to the surface, where the coarse distances are not needed.
    const float band = bandDistance(p);
    return band < 0.8f * mLimit ? std::max(0.f, band) : std::max(band, coarseAt(p));
}

}  // namespace vdbsynth
