#pragma once
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// Coordinates as floats near a common origin. Coordinates of surveys (UTM) are so large beside the model
/// that floats of their own would step by half a metre.
struct LocalPoints {
    std::vector<Vec3f> points;  ///< relative to the origin
    Vec3d origin;               ///< [world] a multiple of a power of two; zero where floats are fine enough
};

/// The ratio of the largest coordinate to the longest side from which on points get an origin: beyond it a
/// float's step is over 1/250 000 of the side.
inline constexpr double kFarRatio = 64;

/// The origin for points in this box: zero unless the box is farther out than kFarRatio times its longest
/// side, else its centre, rounded to the power of two at its longest side, so that sums with it are exact.
/// An empty or infinite box gives zero.
/// @par Repeats yes
Vec3d localOrigin(const Vec3d& boxMin, const Vec3d& boxMax);

/// Where most of some points are, however far out the others may be.
struct PointCore {
    Vec3d centre;       ///< [world] median of each axis
    double spread = 0;  ///< [world] median distance from it along the farthest axis; 0 if all coincide
};

/// Points farther from the centre than this many spreads have no say in the choice of an origin.
inline constexpr double kCoreReach = 1000;

/// The core of the finite points, from at most 65536 of them, evenly spaced in their order. Points at the
/// centre itself (scanners write zeros for pixels without a point) do not count for the spread.
/// @par Cost    O(1)   @par Repeats yes
PointCore coreOf(const std::vector<Vec3d>& points);
PointCore coreOf(const std::vector<Vec3f>& points);
/// Distance along the farthest axis, the one that `spread` is measured in.
double distanceFrom(const PointCore& core, const Vec3d& point);

/// The points as floats, near an origin if the core of the finite ones is far out: single far points do not
/// change it. Values that are not finite stay so; those that floats cannot hold become infinite.
/// @par Cost    O(points)   @par Repeats yes
LocalPoints localPoints(const std::vector<Vec3d>& points);

}  // namespace vdbsynth
