#include "libvdbsynth/points/point_cells.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kFarthest = 1e15;  // [cells] beyond it all share one: what a number still tells apart

// 21 bits for each axis. Cells 2^21 apart share a key, which costs their places a look and is no error.
std::uint64_t part(double x, int by) {
    return std::uint64_t(std::int64_t(std::clamp(std::floor(x), -kFarthest, kFarthest)) + by) & 0x1fffff;
}

}  // namespace

PointCells::PointCells(double side) : mSide(side) {
    if (!(side > 0)) throw Error(ErrorCode::InvalidOption, "the side of cells must be above 0");
}

PointCells::PointCells(const std::vector<Vec3f>& points, double side) : PointCells(side) {
    for (std::size_t p = 0; p < points.size(); ++p) add(cast<double>(points[p]), std::uint32_t(p));
}

void PointCells::add(const Vec3d& place, std::uint32_t number) {
    mCells[keyOf(place, {})].push_back(number);
}

std::uint64_t PointCells::keyOf(const Vec3d& place, const Index3& step) const {
    return (part(place.x / mSide, step.x) << 42) | (part(place.y / mSide, step.y) << 21) |
           part(place.z / mSide, step.z);
}

}  // namespace vdbsynth
