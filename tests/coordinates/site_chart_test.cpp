#include "libvdbsynth/coordinates/site_chart.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("flattened: in the plane as it is, out of it at full length, along the normal nothing") {
    const SiteFrame frame = siteFrame({0, 0, 1}, {1, 0, 0});
    CHECK(frame.t.y == 1);
    const Vec2f flat = flattened(frame, {3, -4, 0});
    CHECK(flat.x == 3);
    CHECK(flat.y == -4);
    // (2, 0, 1.5) is 2.5 long.
    CHECK(flattened(frame, {2, 0, 1.5f}).x == Approx(2.5));
    CHECK(flattened(frame, {2, 0, 1.5f}).y == 0);
    CHECK(length(flattened(frame, {0, 0, 5})) == 0);
    CHECK(length(flattened(frame, {0, 0, 0})) == 0);
}

TEST_CASE("frameRotation: takes a direction's coordinates in one frame to those in another") {
    const SiteFrame from = siteFrame({0, 0, 1}, {1, 0, 0});
    const SiteFrame to = siteFrame({0, 0, 1}, {0, 1, 0});
    const Vec2f rotation = frameRotation(from, to);
    // The world's x is u of the first; in the second it is -v.
    const Vec2f x = rotated({1, 0}, rotation);
    CHECK(x.x == Approx(0).margin(1e-6));
    CHECK(x.y == Approx(-1));
    const Vec2f same = frameRotation(to, to);
    CHECK(same.x == Approx(1));
    CHECK(same.y == Approx(0).margin(1e-6));
}

TEST_CASE("tangentNear: perpendicular to the normal, also for directions along it") {
    const Vec3f t = tangentNear({0, 0, 1}, {3, 0, 4});
    CHECK(t.x == 1);
    CHECK(t.z == 0);
    for (const Vec3f& normal : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 0, 1}})
        for (const Vec3f& direction : {normal, Vec3f{0, 0, 0}}) {
            const Vec3f any = tangentNear(normal, direction);
            CHECK(length(any) == Approx(1));
            CHECK(dot(any, normal) == Approx(0).margin(1e-6));
        }
}
