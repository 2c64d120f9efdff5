#include "libvdbsynth/coordinates/site_tangents.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("anyDirection: one that is not zero") {
    CHECK_FALSE(anyDirection({}));
    CHECK_FALSE(anyDirection({{0, 0, 0}, {0, 0, 0}}));
    CHECK(anyDirection({{0, 0, 0}, {0, 0, -1}}));
}

TEST_CASE("siteTangents: without directions the field is smooth, with few singularities on a ball") {
    const test::PointShape ball = test::spiralSphere(30000, 10);
    const SurfaceSites sites = sitesOfPoints(ball.point, ball.normal, 8);
    std::vector<Vec3f> singularities;
    const std::vector<Vec3f> tangents = siteTangents(sites, {}, 0.2, &singularities);
    CHECK(singularities.size() >= 1);
    CHECK(singularities.size() <= 4);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < sites.size(); ++i)
        for (std::size_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
            turned += dot(tangents[i], tangents[sites.neighbours[k]]) < 0.94f;  // 20 degrees
    CHECK(double(turned) < 0.02 * double(sites.neighbours.size()));
}

TEST_CASE("siteTangents: those given stay, others follow, along normals is an error") {
    const test::PointShape plane = test::latticePlane(20);
    const SurfaceSites sites = sitesOfPoints(plane.point, plane.normal, 8);
    std::vector<Vec3f> given(400, {0, 0, 0});
    given[7] = {0, 3, 0};
    for (const Vec3f& t : siteTangents(sites, given, 1)) REQUIRE(t.y == Approx(1));
    given[7] = {0, 0, 1};
    CHECK_THROWS_AS(siteTangents(sites, given, 1), Error);
}

TEST_CASE("siteTangents: same bits for any number of threads") {
    const test::PointShape ball = test::spiralSphere(25000, 10);
    const SurfaceSites sites = sitesOfPoints(ball.point, ball.normal, 8);
    const std::vector<Vec3f> one = siteTangents(sites, {}, 0.2, nullptr, test::onThreads(1)),
                             four = siteTangents(sites, {}, 0.2, nullptr, test::onThreads(4));
    for (std::size_t i = 0; i < one.size(); ++i) REQUIRE(dot(one[i] - four[i], one[i] - four[i]) == 0);
}
