#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Squared distances to a sample's full surface, read from its band: eq. 1's distance to the nearest
/// triangle of [breckon2006] is a look-up. Trilinear between voxels, as sampleTrilinear
/// (grid/field_sampling.h).
///
/// A band knows distances up to its half-width. Decision: what is farther, or beyond the field's box,
/// counts as the half-width: a lower bound, so that a neighbourhood that leaves the sample is penalised,
/// and by the same amount everywhere. A band of at least the relief's amplitude (distance/widen_band.h)
/// ranks the rest.
///
/// Bricks are kept with the next layer of voxels on their upper sides, so that the eight voxels of a
/// look-up lie in one.
class ReliefDistance {
public:
    /// @param band       [voxels] signed or not, any corner
    /// @param origin     [world] position of voxel 0,0,0
    /// @param voxel      [world] side, above 0
    /// @param halfWidth  [voxels] where the band ends, above 0
    /// @throw Error InvalidOption (an empty box, voxel, halfWidth), BadData (values that are not finite)
    /// @par Cost    O(bricks); memory 2.9 KB for each brick that the band touches
    ReliefDistance(const BrickField& band, const Vec3f& origin, double voxel, float halfWidth);

    double voxel() const { return mVoxel; }
    float halfWidth() const { return mHalfWidth; }

    /// A place [world] in voxels from the field's corner.
    Vec3f toVoxels(const Vec3f& place) const { return (place - mCorner) * float(1 / mVoxel); }

    /// Whether the field knows anything there. @param place  by toVoxels
    bool inBox(const Vec3f& place) const {
        return place.x >= 0 && place.x < mEnd.x && place.y >= 0 && place.y < mEnd.y && place.z >= 0 &&
               place.z < mEnd.z;
    }

    /// Squared distance [voxels^2], at most halfWidth^2. @param place  by toVoxels
    float squared(const Vec3f& place) const {
        if (!inBox(place)) return mMost;
        const int x = int(place.x), y = int(place.y), z = int(place.z);
        const std::int32_t slot = mSlots[latticeIndex({x >> 3, y >> 3, z >> 3}, mBricks)];
        if (slot < 0) return mMost;
        const float* v = mSamples.data() + std::size_t(slot) * kCube +
                         std::size_t(((x & 7) * kSide + (y & 7)) * kSide + (z & 7));
        const float fx = place.x - float(x), fy = place.y - float(y), fz = place.z - float(z);
        const float a = v[0] + (v[1] - v[0]) * fz, b = v[kSide] + (v[kSide + 1] - v[kSide]) * fz;
        const float* w = v + kSide * kSide;
        const float c = w[0] + (w[1] - w[0]) * fz, d = w[kSide] + (w[kSide + 1] - w[kSide]) * fz;
        const float low = a + (b - a) * fy, high = c + (d - c) * fy;
        const float distance = low + (high - low) * fx, square = distance * distance;
        return square < mMost ? square : mMost;
    }

private:
    static constexpr int kSide = BrickField::kSide + 1;
    static constexpr std::size_t kCube = std::size_t(kSide) * kSide * kSide;

    Vec3f mCorner;  // [world] of the box
    double mVoxel = 1;
    float mHalfWidth = 0, mMost = 0;
    Vec3f mEnd;  // [voxels] of the box, where no cell begins
    Index3 mBricks;
    std::vector<std::int32_t> mSlots;  // per brick: its samples, or -1 where the band does not reach
    std::vector<float> mSamples;       // kCube each
};

}  // namespace vdbsynth
