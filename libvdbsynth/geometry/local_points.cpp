#include "libvdbsynth/geometry/local_points.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

Vec3d localOrigin(const Vec3d& boxMin, const Vec3d& boxMax) {
    double side = 0, farthest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        side = std::max(side, boxMax[axis] - boxMin[axis]);
        farthest = std::max({farthest, std::abs(boxMin[axis]), std::abs(boxMax[axis])});
    }
    if (!(side > 0) || !std::isfinite(farthest) || farthest <= kFarRatio * side) return {0, 0, 0};
    const double step = std::ldexp(1.0, std::ilogb(side));
    Vec3d origin;
    for (int axis = 0; axis < 3; ++axis)
        origin[axis] = std::round((boxMin[axis] + boxMax[axis]) * 0.5 / step) * step + 0.0;
    return origin;
}

LocalPoints localPoints(const std::vector<Vec3d>& points) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Vec3d& p : points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], p[axis]);
            high[axis] = std::max(high[axis], p[axis]);
        }
    }
    LocalPoints local;
    local.origin = localOrigin(low, high);
    local.points.reserve(points.size());
    for (const Vec3d& p : points) local.points.push_back(cast<float>(p - local.origin));
    return local;
}

}  // namespace vdbsynth
