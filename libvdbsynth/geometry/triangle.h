#pragma once
#include "libvdbsynth/math/vec3.h"

namespace vdbsynth {

/// Barycentric coordinates of the triangle's point nearest to p [ericson2005, section 5.1.5]; they sum to 1.
/// A triangle of zero area gives a point on one of its edges.
Vec3d nearestInTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace vdbsynth
