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
