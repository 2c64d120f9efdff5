#pragma once
#include "libvdbsynth/surface/sweep_distance.h"

#include <memory>

namespace vdbsynth {

/// Right-handed orthonormal axes at a place: b = t x n.
struct Frame {
    Vec3f t{1, 0, 0}, n{0, 0, 1}, b{0, -1, 0};
};

/// A frame and a sweep distance everywhere near a surface [bhat2004, 5.2, 5.4]: n is the gradient of the
/// distance, t that of the nearest place on the surface, at right angles to n; the sweep distance is that of
/// the nearest place.
class FrameField {
public:
    /// @param distance  box as the shell's; kept
    FrameField(std::shared_ptr<const BrickField> distance, SurfaceShell shell, DirectionField directions,
               SweepDistance sweep);

    /// @param point  [voxels] of the distance field
    /// @return false where no shell voxel is near the nearest place: beside a medial axis, outside the field
    bool at(const Vec3f& point, Frame& frame, float& sweep) const;

    const SurfaceShell& shell() const { return mShell; }
    const DirectionField& directions() const { return mDirections; }
    const SweepDistance& sweep() const { return mSweep; }
    const BrickField& distance() const { return *mDistance; }

private:
    std::shared_ptr<const BrickField> mDistance;
    SurfaceShell mShell;
    DirectionField mDirections;
    SweepDistance mSweep;
};

/// The turn that takes one frame's axes to another's, as a rotation vector: its axis times its angle
/// [radians].
Vec3f rotationBetween(const Frame& from, const Frame& to);

/// frame.t, n, b from a normal and any direction; the direction along the normal takes any tangent.
Frame frameFrom(const Vec3f& normal, const Vec3f& direction);

}  // namespace vdbsynth
