#include "libvdbsynth/coordinates/site_chart.h"

namespace vdbsynth {

Vec3f tangentNear(const Vec3f& normal, const Vec3f& direction) {
    Vec3f t = direction - normal * dot(direction, normal);
    if (!(length(t) > 1e-3f * length(direction))) {
        const Vec3f axis = std::abs(normal.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
        t = axis - normal * dot(axis, normal);
    }
    return normalized(t);
}

}  // namespace vdbsynth
