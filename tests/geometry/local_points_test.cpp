#include "libvdbsynth/geometry/local_points.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace vdbsynth;

TEST_CASE("localPoints: coordinates of a survey keep their millimetres", "[geometry][hand]") {
    const std::vector<Vec3d> utm{{565021.123, 5648340.271, 101.5}, {565023.123, 5648340.272, 101.5}};
    const LocalPoints local = localPoints(utm);
    // The longest side is 2, so the origin is a multiple of 2.
    CHECK(local.origin.x == 565022);
    CHECK(local.origin.y == 5648340);
    CHECK(local.origin.z == 102);
    for (std::size_t i = 0; i < 2; ++i)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(local.origin[axis] + double(local.points[i][axis]) == Approx(utm[i][axis]).margin(1e-6));
}

TEST_CASE("localPoints: near coordinates are plain floats without an origin", "[geometry][hand]") {
    const LocalPoints local = localPoints({{0.1, 200, -3}, {6.1, 201, 5}});
    CHECK(length(local.origin) == 0);
    CHECK(local.points[0].x == 0.1f);
    CHECK(local.points[1].y == 201.f);
}

TEST_CASE("localPoints: degenerate boxes have no origin", "[geometry][degenerate]") {
    CHECK(length(localPoints({}).origin) == 0);
    CHECK(length(localPoints({{1e9, 1e9, 1e9}}).origin) == 0);
    // One at infinity, one not a number: the others decide.
    const LocalPoints local =
        localPoints({{1e6, 0, 0}, {NAN, 0, 0}, {1e6 + 1, INFINITY, 0}, {1e6 + 4, 0, 0}});
    CHECK(local.origin.x == 1000004);
    CHECK(std::isnan(local.points[1].x));
    CHECK(std::isinf(local.points[2].y));
    CHECK(length(localOrigin({1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300})) == 0);
}

TEST_CASE("coreOf: medians by hand, zeros at the centre do not count", "[geometry][hand]") {
    const PointCore core =
        coreOf(std::vector<Vec3d>{{1, 0, 0}, {2, 4, 0}, {3, 0, 1e30}, {4, 0, 0}, {100, 0, 0}});
    CHECK(core.centre.x == 3);
    CHECK(core.centre.y == 0);
    CHECK(core.centre.z == 0);
    // Distances 2, 4, 1e30, 1, 97.
    CHECK(core.spread == 4);
    CHECK(distanceFrom(core, {3, -7, 2}) == 7);
    CHECK(coreOf(std::vector<Vec3f>{}).spread == 0);
    CHECK(coreOf(std::vector<Vec3f>(9, Vec3f{5, 5, 5})).spread == 0);
    CHECK(coreOf(std::vector<Vec3d>{{NAN, 0, 0}, {0, INFINITY, 0}}).spread == 0);
    // Most are zeros, as of pixels without a point.
    CHECK(coreOf(std::vector<Vec3f>{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {7, 0, 0}, {0, 8, 0}}).spread == 8);
}

TEST_CASE("localPoints: far points do not spoil the origin of the others", "[geometry][regression]") {
    std::vector<Vec3d> utm;
    for (int i = 0; i < 200; ++i)
        utm.push_back({565021.123 + i % 7 * 0.25, 5648340.271 + i % 11 * 0.25, 101.5 + i % 13 * 0.25});
    for (const Vec3d& far : {Vec3d{0, 0, 0}, Vec3d{1e30, 0, 0}, Vec3d{1e300, -1e300, 1e300}}) {
        utm.push_back(far);
        const LocalPoints local = localPoints(utm);
        REQUIRE(local.points.size() == utm.size());
        for (std::size_t i = 0; i < 200; ++i)
            for (int axis = 0; axis < 3; ++axis)
                REQUIRE(local.origin[axis] + double(local.points[i][axis]) ==
                        Approx(utm[i][axis]).margin(1e-6));
    }
}
