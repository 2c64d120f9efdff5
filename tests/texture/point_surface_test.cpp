#include "libvdbsynth/texture/point_surface.h"

#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

TEST_CASE("pointSurface: sites are the points along a curve, lengths in spacings") {
    const TextureTarget target = test::targetOf(test::latticePlane(12));
    const PointSurface surface = pointSurface(target, 8);
    CHECK(surface.spacing == Approx(1));
    for (std::size_t i = 0; i < surface.order.size(); ++i)
        REQUIRE(length(surface.sites.point[i] - target.point[surface.order[i]]) == 0);
    CHECK(pointSurface({{{1, 2, 3}}, {{0, 0, 1}}, {}, {}}, 8).spacing == 1);
    RunContext little;
    little.maxMemory = 1000;
    CHECK(test::thrownBy([&] { pointSurface(target, 8, little); }).code == int(ErrorCode::Memory));
    CHECK_THROWS_AS(pointSurface(target, 2), Error);
    CHECK_THROWS_AS(pointSurface(target, 257), Error);
    CHECK_THROWS_AS(pointSurface({}, 8), Error);
}

TEST_CASE("siteTangent: given, up, random") {
    TextureTarget target = test::targetOf(test::latticePlane(4));
    const PointOrientationOptions up;
    const PointSurface plain = pointSurface(target, 8);
    CHECK(length(siteTangent(plain, 0, up, 0) - Vec3f{1, 0, 0}) < 1e-6f);  // +v is (0, 1, 0)
    target.direction.assign(target.point.size(), {0, 0, 0});
    target.direction[plain.order[0]] = {1, 1, 5};
    const PointSurface given = pointSurface(target, 8);
    CHECK(length(siteTangent(given, 0, up, 0) - Vec3f{0.70710678f, 0.70710678f, 0}) < 1e-6f);
    CHECK(length(siteTangent(given, 1, up, 0) - Vec3f{1, 0, 0}) < 1e-6f);
    const PointOrientationOptions drawn{PointOrientation::Random, {0, 1, 0}};
    const std::vector<Vec3f> tangents = siteTangents(plain, drawn);
    Vec3f sum;
    for (const Vec3f& t : tangents) {
        CHECK(length(t) == Approx(1));
        CHECK(t.z == Approx(0).margin(1e-6));
        sum = sum + t;
    }
    CHECK(length(sum) < 12);
    CHECK_THROWS_AS(validate(PointOrientationOptions{PointOrientation::Up, {0, 0, 0}}), Error);
}

TEST_CASE("siteTangent: an up vector along the normal still gives a tangent") {
    const PointSurface surface = pointSurface(test::targetOf(test::latticePlane(3)), 8);
    const Vec3f t = siteTangent(surface, 0, {PointOrientation::Up, {0, 0, 3}}, 0);
    CHECK(length(t) == Approx(1));
    CHECK(t.z == Approx(0).margin(1e-6));
}

TEST_CASE("inTargetOrder: puts every site at its point") {
    TexturedSites sites = uncoloured(3, 2);
    sites.values = {0, 1, 2, 3, 4, 5};
    sites.coordinate = {{7, 0}, {8, 0}, {9, 0}};
    const TexturedSites out = inTargetOrder(sites, {2, 0, 1});
    CHECK(out.values == std::vector<float>{2, 3, 4, 5, 0, 1});
    CHECK(out.coordinate[2].x == 7);
}

TEST_CASE("RandomOrder: every number once") {
    RandomOrder order(100, 3, 1);
    std::vector<std::uint32_t> seen;
    const auto odd = [](std::uint32_t i) { return i % 2 == 1; };
    for (std::uint32_t i; (i = order.next(odd)) < 100;) seen.push_back(i);
    CHECK(seen.size() == 50);
    CHECK_FALSE(std::is_sorted(seen.begin(), seen.end()));
    std::sort(seen.begin(), seen.end());
    CHECK(std::unique(seen.begin(), seen.end()) == seen.end());
}

TEST_CASE("requireSample: refuses what is no image") {
    CHECK_THROWS_AS(requireSample({}), Error);
    CHECK_THROWS_AS(requireSample({2, 2, 1, false, {1, 2, 3}}), Error);
    CHECK_THROWS_AS(requireSample({1, 1, 1, false, {NAN}}), Error);
    CHECK_NOTHROW(requireSample({1, 1, 1, false, {0.5f}}));
}
