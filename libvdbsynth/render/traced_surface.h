#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

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
    /// @par Cost    1.5 kB per brick of the band; distances: O(voxels near the surface + up to 2.5 million)
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
    /// Distance to the surface at any place, also outside the voxels: exact in the band, within a sample's
    /// diagonal (coarseness() * 1.8) elsewhere, never negative.
    float farDistance(const Vec3f& p) const;
    int coarseness() const { return mCoarseness; }
    /// Unit normal: central differences of trilinear distances over three quarters of a voxel, which are
    /// continuous, where the gradient of a trilinear cell is not.
    Vec3f normalAt(const Vec3f& p) const;
    /// Half of the diagonal of the solid's box [voxels].
    float reach() const { return mReach; }
    Vec3f middle() const { return mMiddle; }

private:
    void layOut(const BrickField& field, const RunContext& ctx);
    void measureEmptiness();
    float coarseAt(const Vec3f& p) const;

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
    Vec3f mMiddle;
};

}  // namespace vdbsynth
