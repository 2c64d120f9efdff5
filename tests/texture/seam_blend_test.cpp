#include "libvdbsynth/texture/seam_blend.h"

#include "tests/support/point_shapes.h"
#include "tests/support/sample_images.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

constexpr int kSide = 32;

// A lattice a texel apart of which one chart covers the whole, or the right half lies elsewhere in the
// sample.
struct Charts {
    CoordinateSites sites;
    CoordinateResult coordinates;
    std::vector<float> values;
    std::vector<char> blended = std::vector<char>(kSide * kSide, 0);

    Charts(const SampleImage& sample, float jump) {
        test::PointShape plane = test::latticePlane(kSide);
        sites.sites = sitesOfPoints(plane.point, plane.normal, kSiteNeighbours);
        sites.tangent.assign(sites.sites.size(), {1, 0, 0});
        coordinates.tangent = sites.tangent;
        for (const Vec3f& p : sites.sites.point) {
            coordinates.coordinate.push_back({p.x + 20.5f, p.y + 20.5f + (p.x < kSide / 2 ? 0 : jump)});
            values.push_back(nearestTexel(sample, coordinates.coordinate.back())[0]);
        }
    }
};

}  // namespace

TEST_CASE("blendSeams: one chart stays as it is") {
    const SampleImage noise = test::noiseSample(96, 96);
    Charts charts(noise, 0);
    const std::vector<float> before = charts.values;
    CHECK(blendSeams(charts.sites, charts.coordinates, {noise}, 1, charts.values, charts.blended) == 0);
    CHECK(charts.values == before);
}

TEST_CASE("blendSeams: only sites beside a seam are mixed") {
    const SampleImage noise = test::noiseSample(96, 96);
    Charts charts(noise, 30);
    const std::vector<float> before = charts.values;
    const std::size_t mixed =
        blendSeams(charts.sites, charts.coordinates, {noise}, 1, charts.values, charts.blended);
    std::size_t marked = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const float x = charts.sites.sites.point[i].x;
        marked += charts.blended[i] != 0;
        if (x < kSide / 2 - 3 || x > kSide / 2 + 2) {
            REQUIRE(charts.values[i] == before[i]);
            REQUIRE(charts.blended[i] == 0);
        }
    }
    CHECK(mixed == marked);
    CHECK(mixed >= 2 * kSide);
}

TEST_CASE("blendSeams: samples of different labels are not mixed") {
    const SampleImage noise = test::noiseSample(96, 96);
    Charts charts(noise, 30);
    for (const Vec3f& p : charts.sites.sites.point) charts.sites.label.push_back(p.x < kSide / 2 ? 0 : 1);
    CHECK(blendSeams(charts.sites, charts.coordinates, {noise, noise}, 1, charts.values, charts.blended) ==
          0);
}
