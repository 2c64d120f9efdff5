#pragma once
#include "libvdbsynth/coordinates/coordinate_level.h"
#include "tests/support/point_shapes.h"
#include "tests/support/sample_images.h"

// Levels of coordinate synthesis for the tests of its steps.
namespace vdbsynth::test {

/// A lattice of side x side sites a texel apart, u along x, without coordinates.
inline CoordinateLevel planeLevel(int side, const SampleImage& sample, std::size_t similar = 2) {
    const PointShape plane = latticePlane(side);
    CoordinateLevel level;
    level.sites = sitesOfPoints(plane.point, plane.normal, kSiteNeighbours);
    level.tangent.assign(level.sites.size(), {1, 0, 0});
    level.field = level.tangent;
    level.label.assign(level.sites.size(), 0);
    level.samples.push_back(sampleLevel(sample, 1, similar));
    return level;
}

/// The same with a rigid copy of the sample: site (0, 0) has (10.5, 12.5).
inline CoordinateLevel copiedPlane(int side, const SampleImage& sample) {
    CoordinateLevel level = planeLevel(side, sample);
    for (const Vec3f& p : level.sites.point) level.coordinate.push_back({p.x + 10.5f, p.y + 12.5f});
    return level;
}

}  // namespace vdbsynth::test
