#pragma once
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/transfer/relief_transfer.h"

#include <algorithm>
#include <cmath>
#include <vector>

// A scan laid back onto its own base.
namespace vdbsynth::test {

/// The map of a target that is the base of a sample: every site takes the relief of the place where it lies,
/// in the frame that the sample's atlas has there.
inline ReliefMap identityMap(const ReliefTarget& target, const ReliefSample& sample) {
    const SampleImage& image = sample.image;
    std::vector<Vec3f> place;
    std::vector<Index3> texel;
    const auto shown = [&](int x, int y) { return sample.known[std::size_t(y * image.width + x)] != 0; };
    const auto placeOf = [&](int x, int y) { return sample.place[std::size_t(y * image.width + x)]; };
    for (int y = 1; y + 1 < image.height; ++y)
        for (int x = 1; x + 1 < image.width; ++x)
            if (shown(x, y) && shown(x - 1, y) && shown(x + 1, y)) {
                place.push_back(placeOf(x, y));
                texel.push_back({x, y, 0});
            }
    const PointNeighbours nearest(place);
    ReliefMap map;
    for (std::size_t i = 0; i < target.point.size(); ++i) {
        std::uint32_t k = 0;
        float squared = 0;
        nearest.nearest(target.point[i], 1, &k, &squared);
        const Index3& t = texel[k];
        const Vec3f& normal = target.normal[i];
        const Vec3f tangent = tangentNear(normal, placeOf(t.x + 1, t.y) - placeOf(t.x - 1, t.y));
        const Vec2f off = flattened(siteFrame(normal, tangent), target.point[i] - place[k]);
        map.sample.push_back(0);
        map.tangent.push_back(tangent);
        map.coordinate.push_back(Vec2f{float(t.x) + 0.5f, float(t.y) + 0.5f} + off);
    }
    return map;
}

/// How far a surface lies from another one's zero level, over its vertices. [voxels]
struct SurfaceError {
    double rms = 0, most = 0, beyond = 0;  ///< `beyond`: share of the vertices over half a voxel away
};
inline SurfaceError surfaceError(const BrickField& made, const BrickField& wanted) {
    SurfaceError error;
    const Mesh mesh = zeroLevel(made, made.box(), Facing::Outward);
    for (const Vec3f& p : mesh.points) {
        const double d = std::abs(double(sampleTrilinear(wanted, p)));
        error.rms += d * d / double(mesh.points.size());
        error.most = std::max(error.most, d);
        error.beyond += (d > 0.5 ? 1.0 : 0.0) / double(mesh.points.size());
    }
    error.rms = std::sqrt(error.rms);
    return error;
}

/// A target that is a sample's base.
inline ReliefTarget ownBase(const ReliefSample& sample) {
    ReliefTarget target;
    target.distance = sample.surface->distance;
    target.reach = sample.surface->reach;
    makeSites(target);
    return target;
}

}  // namespace vdbsynth::test
