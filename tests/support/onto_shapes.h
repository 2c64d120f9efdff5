#pragma once
#include "libvdbsynth/patch/onto/onto_surface.h"
#include "tests/support/patch_shapes.h"

// Surfaces to lay patches over.
namespace vdbsynth::test {

/// Points on a tube about the z axis without ends, `apart` apart, every other row moved by a half.
inline PointShape tubeShape(double radius, double height, double apart) {
    PointShape shape;
    const int around = int(std::lround(2 * kPi * radius / apart)), rows = int(height / apart);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < around; ++i) {
            const double a = 2 * kPi * (i + 0.5 * (j & 1)) / around;
            const Vec3d n{cosine(a), sine(a), 0};
            shape.point.push_back(cast<float>(n * radius + Vec3d{0, 0, (j + 0.5) * apart}));
            shape.normal.push_back(cast<float>(n));
        }
    return shape;
}

/// A square of the plane z = 0 from 0 to `side`, points `apart` apart, moved at random.
inline PointShape squareShape(double side, double apart) {
    PointShape shape;
    const int count = int(side / apart);
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j) {
            Random random(5, std::uint64_t(i) * 4096 + std::uint64_t(j));
            const double x = i + 0.5 + random.uniform(-0.2, 0.2), y = j + 0.5 + random.uniform(-0.2, 0.2);
            shape.point.push_back({float(x * apart), float(y * apart), 0});
            shape.normal.push_back({0, 0, 1});
        }
    return shape;
}

/// As a surface whose tangents run along an axis.
inline OntoSurface surfaceAlong(const PointShape& shape, const Vec3f& axis, double apart) {
    return ontoSurface(shape.point, shape.normal, std::vector<Vec3f>(shape.point.size(), axis), apart);
}

/// The site nearest to a place.
inline std::uint32_t siteAt(const OntoSurface& surface, const Vec3f& place) {
    std::uint32_t best = 0;
    for (std::uint32_t s = 1; s < surface.sites.size(); ++s)
        if (length(surface.sites.point[s] - place) < length(surface.sites.point[best] - place)) best = s;
    return best;
}

}  // namespace vdbsynth::test
