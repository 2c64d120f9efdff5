#include "libvdbsynth/points/point_set_surface.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

TEST_CASE("PointSetSurface.intersect: a ray down on a plane, by hand") {
    const test::PointShape plane = test::latticePlane(40);
    const PointSetSurface surface(plane.point, plane.normal);
    const auto hit = surface.intersect({15, 15, 5}, {3, 0, -5}, 100);
    REQUIRE(hit);
    CHECK(length(hit->point - Vec3d{18, 15, 0}) < 1e-3);
    CHECK(length(hit->normal - Vec3d{0, 0, 1}) < 1e-4);
    // Too short, away from it, along it, of no direction.
    CHECK_FALSE(surface.intersect({15, 15, 5}, {0, 0, -1}, 4.9));
    CHECK_FALSE(surface.intersect({15, 15, 5}, {0, 0, 1}, 100));
    CHECK_FALSE(surface.intersect({15, 15, 2}, {1, 0, 0}, 20));
    CHECK_FALSE(surface.intersect({15, 15, 5}, {0, 0, 0}, 100));
    CHECK_FALSE(surface.intersect({15, 15, 5}, {0, 0, -1}, -1));
    // From the surface itself, and from far away.
    CHECK(length(surface.intersect({15, 15, 0}, {0, 0, 1}, 3)->point - Vec3d{15, 15, 0}) < 1e-3);
    CHECK(length(surface.intersect({15, 15, 1e5}, {0, 0, -1}, 1e6)->point - Vec3d{15, 15, 0}) < 1e-3);
    CHECK_FALSE(surface.intersect({1000, 15, 1e5}, {0, 0, -1}, 1e6));
}

TEST_CASE("PointSetSurface.intersect: hits of a sphere are the exact ones, from within and without") {
    const double radius = 20;
    const test::PointShape sphere = test::spiralSphere(std::size_t(4 * kPi * radius * radius), radius);
    const PointSetSurface surface(sphere.point, sphere.normal);
    double largest = 0;
    std::size_t missed = 0;
    for (std::uint64_t i = 0; i < 3000; ++i) {
        Random random(9, i);
        const Vec3d to = normalized(Vec3d{random.normal(), random.normal(), random.normal()}) * radius;
        const Vec3d from = Vec3d{random.normal(), random.normal(), random.normal()} * 15.0;
        const Vec3d along = normalized(to - from);
        // The nearer root of |from + t along| = radius, t > 0.
        const double b = dot(from, along), root = std::sqrt(b * b - dot(from, from) + radius * radius);
        const double t = -b - root > 0 ? -b - root : -b + root;
        // A ray that only grazes the sphere is ill-conditioned.
        if (root < 4) continue;
        const auto hit = surface.intersect(from, along * 7.0, 1000);
        if (!hit) {
            ++missed;
            continue;
        }
        largest = std::max(largest, length(hit->point - (from + along * t)));
    }
    CHECK(missed == 0);
    CHECK(largest < 0.005);
}

TEST_CASE("PointSetSurface.intersect: between opposite sheets, by facing, and through a pile") {
    test::PointShape sheets = test::latticePlane(40);
    for (const float depth : {-2.f, -5.f, -7.f}) {
        test::PointShape next = test::latticePlane(40);
        for (Vec3f& p : next.point) p.z = depth;
        if (depth == -2.f || depth == -7.f)
            for (Vec3f& n : next.normal) n.z = -1;
        sheets = test::joined(sheets, next);
    }
    const PointSetSurface surface(sheets.point, sheets.normal);
    const auto depth = [](const std::optional<SurfaceFoot>& hit) { return hit ? hit->point.z : 99.0; };
    CHECK(depth(surface.intersect({20, 20, 3}, {0, 0, -1}, 20)) == Approx(0).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, -0.7}, {0, 0, -1}, 20)) == Approx(-2).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, -0.7}, {0, 0, 1}, 20)) == Approx(0).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, -3.5}, {0, 0, -1}, 20)) == Approx(-5).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, -3.5}, {0, 0, 1}, 20)) == Approx(-2).margin(1e-3));
    // Those that face up only; half way between two of them the value changes its sign without a surface.
    const Vec3d up{0, 0, 1};
    CHECK(depth(surface.intersect({20, 20, -0.7}, {0, 0, -1}, 20, up)) == Approx(-5).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, -4}, {0, 0, 1}, 20, up)) == Approx(0).margin(1e-3));
    CHECK(depth(surface.intersect({20, 20, 3}, {0, 0, -1}, 20, up * -1.0)) == Approx(-2).margin(1e-3));
}
