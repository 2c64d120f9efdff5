#include "libvdbsynth/geometry/local_points.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::size_t kSample = 65536;

bool isFinite(const Vec3d& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

template <typename T>
PointCore coreOfAny(const std::vector<Vec3<T>>& points) {
    std::vector<Vec3d> sample;
    const std::size_t count = std::min(points.size(), kSample);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d p = cast<double>(points[std::size_t(double(i) / double(count) * double(points.size()))]);
        if (isFinite(p)) sample.push_back(p);
    }
    PointCore core;
    if (sample.empty()) return core;
    std::vector<double> values(sample.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < sample.size(); ++i) values[i] = sample[i][axis];
        core.centre[axis] = medianOf(values);
    }
    values.clear();
    for (const Vec3d& p : sample)
        if (distanceFrom(core, p) > 0) values.push_back(distanceFrom(core, p));
    if (!values.empty()) core.spread = medianOf(values);
    return core;
}

}  // namespace

PointCore coreOf(const std::vector<Vec3d>& points) {
    return coreOfAny(points);
}

PointCore coreOf(const std::vector<Vec3f>& points) {
    return coreOfAny(points);
}

double distanceFrom(const PointCore& core, const Vec3d& point) {
    const Vec3d away = point - core.centre;
    return std::max({std::abs(away.x), std::abs(away.y), std::abs(away.z)});
}

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
    const PointCore core = coreOf(points);
    for (const Vec3d& p : points) {
        if (!isFinite(p) || distanceFrom(core, p) > kCoreReach * core.spread) continue;
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
