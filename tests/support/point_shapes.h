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

/// A torus about the z axis, a point to each unit of area: rings of even points about its tube.
inline PointShape ringTorus(double radius, double tube) {
    PointShape shape;
    const int rings = int(2 * kPi * tube);
    for (int j = 0; j < rings; ++j) {
        const double b = 2 * kPi * j / rings, across = radius + tube * cosine(b);
        const int count = int(2 * kPi * across);
        for (int i = 0; i < count; ++i) {
            const double a = 2 * kPi * (i + 0.5 * (j & 1)) / count;
            const Vec3d n{cosine(a) * cosine(b), sine(a) * cosine(b), sine(b)};
            shape.point.push_back(cast<float>(Vec3d{radius * cosine(a), radius * sine(a), 0} + n * tube));
            shape.normal.push_back(cast<float>(n));
        }
    }
    return shape;
}

/// The two sides of the edge along y of the solid x < 0, z < 0: lattices a unit apart, half a unit from the
/// edge.
inline PointShape latticeWedge(int side) {
    PointShape shape;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < 2 * side; ++j) {
            shape.point.push_back({-float(i) - 0.5f, float(j) + 0.5f, 0});
            shape.normal.push_back({0, 0, 1});
            shape.point.push_back({0, float(j) + 0.5f, -float(i) - 0.5f});
            shape.normal.push_back({1, 0, 0});
        }
    return shape;
}

/// Both as one.
inline PointShape joined(PointShape a, const PointShape& b) {
    a.point.insert(a.point.end(), b.point.begin(), b.point.end());
    a.normal.insert(a.normal.end(), b.normal.begin(), b.normal.end());
    return a;
}

}  // namespace vdbsynth::test
