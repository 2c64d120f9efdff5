#include "libvdbsynth/texture/region_blend.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/texture/surface_texture.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

using namespace vdbsynth;

namespace {

SampleImage flatSample(float value) {
    return {8, 8, 1, true, std::vector<float>(64, value)};
}

// u of a large sample as its value, in hundredths.
SampleImage rampSample() {
    SampleImage image{100, 100, 1, false, {}};
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) image.values.push_back((float(x) + 0.5f) / 100);
    return image;
}

// A lattice of side 40 a texel apart, whose label changes at x = 20; coordinates are positions.
struct Strip {
    CoordinateSites sites;
    CoordinateResult coordinates;
    std::vector<float> values;
    std::vector<char> blended;

    Strip(float left, float right) {
        test::PointShape plane = test::latticePlane(40);
        for (const Vec3f& p : plane.point) {
            sites.label.push_back(p.x >= 20);
            values.push_back(p.x >= 20 ? right : left);
            coordinates.coordinate.push_back({p.x + 0.5f, p.y + 0.5f});
            coordinates.tangent.push_back({1, 0, 0});
        }
        sites.sites = sitesOfPoints(plane.point, plane.normal, kSiteNeighbours);
        sites.tangent = coordinates.tangent;
        blended.assign(values.size(), 0);
    }
    std::size_t blend(const std::vector<SampleImage>& samples, double width) {
        return blendRegions(sites, coordinates, samples, 1, width, false, values, blended);
    }
};

double smooth(double t) {
    return t * t * (3 - 2 * t);
}

}  // namespace

TEST_CASE("blendRegions: weights are a smooth step of the distance to the border") {
    Strip strip(0, 1);
    CHECK(strip.blend({flatSample(0), flatSample(1)}, 4) == 8 * 40);
    for (std::size_t i = 0; i < strip.values.size(); ++i) {
        // The border is half way between x = 19 and x = 20.
        const double beyond = double(strip.sites.sites.point[i].x) - 19.5;
        const double wanted = std::abs(beyond) < 4 ? smooth((4 + beyond) / 8) : double(beyond > 0);
        REQUIRE(strip.values[i] == Approx(wanted).margin(1e-6));
        REQUIRE(bool(strip.blended[i]) == (std::abs(beyond) < 4));
    }
}

TEST_CASE("blendRegions: the other sample is read where its nearest site continues to") {
    Strip strip(0, 0);
    strip.blend({rampSample(), flatSample(0)}, 3);
    for (std::size_t i = 0; i < strip.values.size(); ++i) {
        const float x = strip.sites.sites.point[i].x;
        if (x < 20 || x > 22) continue;
        const double weight = smooth((3 - (double(x) - 19.5)) / 6);
        REQUIRE(strip.values[i] == Approx(weight * (double(x) + 0.5) / 100).margin(1e-6));
    }
}

TEST_CASE("blendRegions: where three regions meet their weights sum to 1") {
    Strip strip(1, 1);
    for (std::size_t i = 0; i < strip.values.size(); ++i)
        if (strip.sites.sites.point[i].y >= 20) strip.sites.label[i] = 2;
    strip.blend({flatSample(1), flatSample(1), flatSample(1)}, 6);
    for (float value : strip.values) REQUIRE(value == Approx(1));
}

TEST_CASE("blendRegions: nothing without labels or borders, a width of 0 is refused", "[error]") {
    Strip strip(0, 1);
    strip.sites.label.assign(strip.values.size(), 1);
    CHECK(strip.blend({flatSample(0), flatSample(1)}, 4) == 0);
    strip.sites.label.clear();
    CHECK(strip.blend({flatSample(0)}, 4) == 0);
    CHECK(test::contains(test::thrownBy([&] { strip.blend({flatSample(0)}, 0); }).message, "`width`"));
}

TEST_CASE("textureSurface: regions blend on request, the same for any number of threads", "[determinism]") {
    const test::PointShape ball = test::spiralSphere(8000, 10);
    TextureTarget target{ball.point, ball.normal, {}, {}};
    for (const Vec3f& p : ball.point) target.label.push_back(p.z > 0);
    const std::vector<SampleImage> samples{flatSample(0), flatSample(1)};
    SurfaceTextureOptions options;
    CHECK(textureSurface(target, samples, options).regionBlended == 0);
    options.regionBlend = 5;
    const SurfaceTextureResult one = textureSurface(target, samples, options, test::onThreads(1)),
                               three = textureSurface(target, samples, options, test::onThreads(3));
    CHECK(std::memcmp(one.sites.values.data(), three.sites.values.data(), 8000 * sizeof(float)) == 0);
    CHECK(one.regionBlended > 500);
    // Colours of neighbours differ by no more than a step of the ramp.
    const SurfaceSites graph = sitesOfPoints(ball.point, ball.normal, 4);
    for (std::size_t i = 0; i < graph.size(); ++i)
        for (std::size_t k = graph.begin[i]; k < graph.begin[i + 1]; ++k)
            REQUIRE(std::abs(one.sites.values[i] - one.sites.values[graph.neighbours[k]]) < 0.35f);
    options.regionBlend = -1;
    CHECK(test::contains(test::thrownBy([&] { textureSurface(target, samples, options); }).message,
                         "`regionBlend`"));
}
