#pragma once
#include "libvdbsynth/grid/occupancy.h"
#include "tests/support/makers.h"

#include <functional>

// Solids voxel by voxel.
namespace vdbsynth::test {

inline Occupancy solidFrom(const Index3& size, const std::function<bool(const Index3&)>& inside) {
    return Occupancy::fromField(
        test::fieldFrom(size, [&](const Index3& p) { return inside(p) ? -1.f : 1.f; }));
}

inline bool inBall(const Index3& p, double x, double y, double z, double radius) {
    return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y) + (p.z - z) * (p.z - z) < radius * radius;
}

}  // namespace vdbsynth::test
