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

/// The points as floats, near an origin if the finite ones are far out. Values that are not finite stay so.
/// @par Cost    O(points)   @par Repeats yes
LocalPoints localPoints(const std::vector<Vec3d>& points);

}  // namespace vdbsynth
