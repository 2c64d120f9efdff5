#pragma once
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/math/vec3.h"

#include <cmath>
#include <vector>

namespace vdbsynth::test {

/// Points with normals.
struct PointShape {
    std::vector<Vec3f> point, normal;
};

/// `count` points drawn evenly on a square of the given side in the plane z = 0.
inline PointShape randomPlane(std::size_t count, double side, std::uint64_t seed = 1) {
    PointShape shape;
    for (std::size_t i = 0; i < count; ++i) {
        Random random(seed, i);
        shape.point.push_back({float(random.uniform(0, side)), float(random.uniform(0, side)), 0});
        shape.normal.push_back({0, 0, 1});
    }
    return shape;
}

/// A square lattice of points a unit apart in the plane z = 0.
inline PointShape latticePlane(int side) {
    PointShape shape;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            shape.point.push_back({float(x), float(y), 0});
            shape.normal.push_back({0, 0, 1});
        }
    return shape;
}

/// `count` points on a ball's surface, evenly along Fibonacci's spiral.
inline PointShape spiralSphere(std::size_t count, double radius) {
    PointShape shape;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * double(i) + 1) / double(count);
        const double r = std::sqrt(1 - z * z), angle = double(i) * 2.399963229728653;
        const Vec3d n{r * std::cos(angle), r * std::sin(angle), z};
        shape.point.push_back(cast<float>(n * radius));
        shape.normal.push_back(cast<float>(n));
    }
    return shape;
}

}  // namespace vdbsynth::test
