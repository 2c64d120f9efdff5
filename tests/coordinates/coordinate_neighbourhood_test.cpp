#include "libvdbsynth/coordinates/coordinate_neighbourhood.h"

#include "tests/support/coordinate_levels.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("Neighbourhood: in a rigid copy every neighbour continues to the site's own coordinate") {
    const CoordinateLevel level = test::copiedPlane(20, test::noiseSample(64, 64));
    const std::size_t site = 10 * 20 + 10;
    const Neighbourhood near(level, site);
    REQUIRE(near.count() == 8);
    for (std::size_t k = 0; k < 8; ++k) {
        CHECK(near[k].here.x == Approx(20.5));
        CHECK(near[k].here.y == Approx(22.5));
        const Vec3f v =
            level.sites.point[level.sites.neighbours[level.sites.begin[site] + k]] - level.sites.point[site];
        CHECK(near[k].place.x == Approx(v.x).margin(1e-5));
        CHECK(near[k].place.y == Approx(v.y).margin(1e-5));
    }
    // What fits is the feature at that place.
    std::array<float, kFeature> wanted;
    near.wanted(wanted.data());
    const float* own = level.samples[0].feature.data() + std::size_t(22 * 64 + 20) * kFeature;
    for (std::size_t d = 0; d < kFeature; ++d) CHECK(wanted[d] == Approx(own[d]).margin(1e-4));
    CHECK(near.nearestNode(wanted.data()) == 22 * 64 + 20);
}

TEST_CASE("Neighbourhood: a neighbour whose frame is rotated continues along its own axes") {
    CoordinateLevel level = test::copiedPlane(20, test::noiseSample(64, 64));
    const std::size_t site = 10 * 20 + 10, left = site - 1;
    level.tangent[left] = {0, 1, 0};  // its u runs along the world's y, its v along -x
    const Neighbourhood near(level, site);
    for (std::size_t k = 0; k < near.count(); ++k) {
        if (level.sites.neighbours[level.sites.begin[site] + k] != left) continue;
        CHECK(near[k].here.x == Approx(level.coordinate[left].x));
        CHECK(near[k].here.y == Approx(level.coordinate[left].y - 1));
        CHECK(near[k].place.x == Approx(-1));
        CHECK(near[k].place.y == Approx(0).margin(1e-5));
    }
}

TEST_CASE("Neighbourhood: sites of other samples, and those left out, do not count") {
    CoordinateLevel level = test::copiedPlane(20, test::noiseSample(64, 64));
    level.samples.push_back(level.samples[0]);
    const std::size_t site = 10 * 20 + 10;
    level.label[site + 1] = 1;
    CHECK(Neighbourhood(level, site).count() == 7);
    std::vector<char> only(level.sites.size(), 0);
    CHECK(Neighbourhood(level, site, only.data()).empty());
    only[site - 1] = 1;
    CHECK(Neighbourhood(level, site, only.data()).count() == 1);
}
