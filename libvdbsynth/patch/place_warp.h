#pragma once
#include "libvdbsynth/math/vec3.h"

#include <array>

namespace vdbsynth {

/// Where a warp takes a place, and how it changes what is there.
struct WarpedPlace {
    Vec3d place;
    std::array<Vec3d, 3> jacobian;  ///< columns: the derivatives along x, y and z
};

inline double determinant(const std::array<Vec3d, 3>& jacobian) {
    return dot(jacobian[0], cross(jacobian[1], jacobian[2]));
}

/// (J u x J v) / |J u x J v| [duranleau2006, 5.2], u, v, n a right-handed frame: by the columns' cross
/// products, so that no tangents have to be chosen. The normal itself if that vanishes.
inline Vec3d warpedNormal(const std::array<Vec3d, 3>& jacobian, const Vec3d& normal) {
    const Vec3d turned = cross(jacobian[1], jacobian[2]) * normal.x +
                         cross(jacobian[2], jacobian[0]) * normal.y +
                         cross(jacobian[0], jacobian[1]) * normal.z;
    return length(turned) > 1e-12 ? normalized(turned) : normal;
}

}  // namespace vdbsynth
