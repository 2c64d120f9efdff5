#include "libvdbsynth/relief/growth/relief_distance.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

ReliefDistance::ReliefDistance(const BrickField& band, const Vec3f& origin, double voxel, float halfWidth)
    : mVoxel(voxel), mHalfWidth(halfWidth), mMost(halfWidth * halfWidth) {
    if (band.box().empty()) throw Error(ErrorCode::InvalidOption, "the sample's band is empty");
    if (!(voxel > 0) || !std::isfinite(voxel))
        throw Error(ErrorCode::InvalidOption, "the sample's voxel size is not above 0");
    if (!(halfWidth > 0) || !std::isfinite(halfWidth))
        throw Error(ErrorCode::InvalidOption, "the half-width of the sample's band is not above 0");
    if (!band.finite()) throw Error(ErrorCode::BadData, "the sample's band has values that are not finite");
    const Index3 min = band.box().min, size = band.box().size();
    mCorner = origin + Vec3f{float(min.x), float(min.y), float(min.z)} * float(voxel);
    mEnd = {float(size.x - 1), float(size.y - 1), float(size.z - 1)};
    mBricks = {(size.x + 7) >> 3, (size.y + 7) >> 3, (size.z + 7) >> 3};
    mSlots.assign(std::size_t(mBricks.x) * std::size_t(mBricks.y) * std::size_t(mBricks.z), -1);
    std::vector<float> cube(kCube);
    std::size_t brick = 0;
    forEachVoxel(IndexBox::fromSize(mBricks), [&](const Index3& b) {
        const Index3 corner = min + b * BrickField::kSide;
        float constant = 0;
        const bool same = band.constantIn(IndexBox::cube(corner, kSide).intersection(band.box()), constant);
        if (!same || std::abs(constant) < halfWidth) {
            band.readBox(corner, {kSide, kSide, kSide}, cube.data());
            if (std::any_of(cube.begin(), cube.end(), [&](float d) { return std::abs(d) < halfWidth; })) {
                mSlots[brick] = std::int32_t(mSamples.size() / kCube);
                mSamples.insert(mSamples.end(), cube.begin(), cube.end());
            }
        }
        ++brick;
    });
}

}  // namespace vdbsynth
