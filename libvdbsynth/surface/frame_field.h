#pragma once
#include "libvdbsynth/surface/sweep_distance.h"

#include <memory>

namespace vdbsynth {

/// Right-handed orthonormal axes at a point: b = t x n.
struct Frame {
    Vec3f t{1, 0, 0}, n{0, 0, 1}, b{0, -1, 0};
};

/// A frame and a sweep distance everywhere near a surface [bhat2004, 5.2, 5.4]: n is the gradient of the
/// distance, t the tangent of the nearest surface point, made perpendicular to n; the sweep distance is that
/// of the nearest surface point.
class FrameField {
public:
    /// @param distance  same box as the shell's; kept
    FrameField(std::shared_ptr<const BrickField> distance, SurfaceShell shell, DirectionField directions,
               SweepDistance sweep);

    /// @param point  [voxels] of the distance field
    /// @return false if no shell voxel is near the nearest surface point: next to a
    /// medial axis, outside the field
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

/// The rotation from one frame's axes to another's, as a rotation vector: its axis times its angle [radians].
Vec3f rotationBetween(const Frame& from, const Frame& to);

/// frame.t, n, b from a normal and any direction; for a direction along the normal any tangent is used.
Frame frameFrom(const Vec3f& normal, const Vec3f& direction);

}  // namespace vdbsynth
