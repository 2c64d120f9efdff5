#pragma once
#include "libvdbsynth/math/vec3.h"

namespace vdbsynth {

/// Barycentric coordinates of the point of the triangle a, b, c that is nearest to p [ericson2005,
/// section 5.1.5]; they sum to 1. A triangle without area gives a point of one of its edges.
Vec3d nearestInTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace vdbsynth
