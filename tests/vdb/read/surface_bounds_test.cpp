#include "libvdbsynth/vdb/read/surface_bounds.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "tests/vdb/read/fields.h"

using namespace vdbsynth;

TEST_CASE("surfaceBounds: the ball's box, far from the origin, turned and mirrored", "[vdb][property]") {
    const auto grid = test::bandGrid(test::ballField(10), 14, 0.1);
    const WorldBox near = surfaceBounds(*grid);
    CHECK(near.min.x == Approx(-1).epsilon(1e-5));
    CHECK(near.max.z == Approx(1).epsilon(1e-5));
    grid->transform().postTranslate({1e6, 2e6, 3e6});
    CHECK(std::abs(surfaceBounds(*grid).max.z - 3000001) < 1e-5);
    CHECK(std::abs(surfaceBounds(*grid).min.x - 999999) < 1e-5);
    grid->transform().postScale({-1, 1, 1});
    CHECK(std::abs(surfaceBounds(*grid).min.x + 1000001) < 1e-5);
}

TEST_CASE("surfaceBounds: nothing gives zeros, threads change nothing", "[vdb][fast]") {
    CHECK(surfaceBounds(*openvdb::FloatGrid::create(1.f)).max.x == 0);
    const auto grid = test::bandGrid(test::boxField({7, 5, 3}), 12, 0.3);
    RunContext one;
    one.threads = 1;
    CHECK(surfaceBounds(*grid, one).max.y == surfaceBounds(*grid).max.y);
    CHECK(surfaceBounds(*grid).max.y == Approx(1.5));
}
