#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/relief/growth/relief_distance.h"
#include "libvdbsynth/relief/growth/relief_sites.h"
#include "tests/support/point_shapes.h"

#include <algorithm>
#include <cmath>

// Surfaces with relief, of which base, relief and distances are known.
namespace vdbsynth::test {

/// A sine along x on the plane z = 0: amplitude, wavelength [world, also voxels].
struct SineRelief {
    double amplitude = 1.5, wavelength = 12;

    double height(double x) const { return amplitude * std::sin(2 * kPi * x / wavelength); }
    /// Distance of (x, z) to the curve, signed, by a scan along it and a step of Newton's.
    float distance(double x, double z, double halfWidth) const {
        double least = 1e9;
        for (double at = x - halfWidth; at <= x + halfWidth; at += 0.05) {
            const double dx = at - x, dz = height(at) - z;
            least = std::min(least, dx * dx + dz * dz);
        }
        const double d = std::min(std::sqrt(least), halfWidth);
        return float(z < height(x) ? -d : d);
    }
};

/// The band of the sine over [0, side]^2, voxels of 1; voxel 0 is at z = -depth.
inline BrickField sineBand(const SineRelief& sine, int side, int depth, float halfWidth) {
    const Index3 size{side + 1, side + 1, 2 * depth + 1};
    std::vector<float> table;
    for (int x = 0; x < size.x; ++x)
        for (int z = 0; z < size.z; ++z) table.push_back(sine.distance(x, z - depth, double(halfWidth)));
    return BrickField::fromVoxels(IndexBox::fromSize(size), {}, [&](const Index3& p) {
        return table[std::size_t(std::min(p.x, size.x - 1) * size.z + std::min(p.z, size.z - 1))];
    });
}

inline ReliefDistance sineDistance(const SineRelief& sine, int side, int depth = 6, float halfWidth = 6) {
    return ReliefDistance(sineBand(sine, side, depth, halfWidth), {0, 0, float(-depth)}, 1, halfWidth);
}

/// A band whose surface is a sine of the distance to an axis along z through (centre, centre): rings.
inline BrickField ringsBand(const SineRelief& sine, double centre, int side, int depth, float halfWidth) {
    const int most = int(2 * (double(side) + std::abs(centre)));
    constexpr int kFine = 8;  // samples of the radius for each voxel
    std::vector<float> table;
    const int high = 2 * depth + 1;
    for (int r = 0; r <= most * kFine; ++r)
        for (int z = 0; z < high; ++z)
            table.push_back(sine.distance(double(r) / kFine, z - depth, double(halfWidth)));
    return BrickField::fromVoxels(IndexBox::fromSize({side + 1, side + 1, high}), {}, [&](const Index3& p) {
        const double r = std::sqrt((p.x - centre) * (p.x - centre) + (p.y - centre) * (p.y - centre));
        return table[std::size_t(std::lround(r * kFine)) * std::size_t(high) +
                     std::size_t(std::min(p.z, high - 1))];
    });
}

/// Shapes as sites with 8 neighbours each, all with one tangent (projected where it is used).
inline SurfaceSites sitesOf(const PointShape& shape) {
    return sitesOfPoints(shape.point, shape.normal, 8);
}

/// A sample: a jittered lattice over [0, side]^2, stripes across the tangents.
inline ReliefSites sineSample(const SineRelief& sine, int side, double spacing = 1) {
    PointShape shape;
    const int count = int(side / spacing);
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x) {
            Random random(5, std::uint64_t(y * count + x));
            shape.point.push_back({float((x + random.uniform(0.25, 0.75)) * spacing),
                                   float((y + random.uniform(0.25, 0.75)) * spacing), 0});
            shape.normal.push_back({0, 0, 1});
        }
    ReliefSites sample{sitesOf(shape), std::vector<Vec3f>(shape.point.size(), {1, 0, 0}), {}};
    for (const Vec3f& p : shape.point) sample.displacement.push_back({0, 0, float(sine.height(double(p.x)))});
    return sample;
}

}  // namespace vdbsynth::test
