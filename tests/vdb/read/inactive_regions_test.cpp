#include "libvdbsynth/vdb/read/inactive_regions.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"
#include "tests/vdb/read/fields.h"

using namespace vdbsynth;

TEST_CASE("InactiveRegions: a shell has an inside and an outside, with the signs around them",
          "[vdb][property]") {
    test::Band band;
    band.interior = 3;  // as if there were no inside
    for (const double radius : {8.0, 30.0}) {
        const auto grid = test::bandGrid(test::ballField(radius), int(radius) + 5, 1, band);
        const InactiveRegions regions(grid->tree(), true, {});
        const int inside = regions.regionAt({0, 0, 0});
        CHECK_FALSE(regions.isOutside(inside));
        CHECK(regions.isOutside(regions.regionAt({0, 0, int(radius) + 20})));
        CHECK(regions.isOutside(regions.regionAt({0, 0, 100000})));
        CHECK(regions.votes(inside).positive == 0);
        CHECK(regions.votes(inside).negative > 100);
        CHECK(regions.outside().negative == 0);
        CHECK(regions.minorities() == 0);
    }
}

TEST_CASE("InactiveRegions: a hole joins them, unless their own signs keep them apart", "[vdb][property]") {
    const auto grid = test::bandGrid(test::ballField(12), 18, 1);
    grid->fill(openvdb::CoordBBox({-1, -1, 0}, {1, 1, 20}), 3.f, false);
    CHECK(InactiveRegions(grid->tree(), false, {})
              .isOutside(InactiveRegions(grid->tree(), false, {}).regionAt({0, 0, -2})));
    const InactiveRegions apart(grid->tree(), true, {});
    CHECK_FALSE(apart.isOutside(apart.regionAt({0, 0, -2})));
    CHECK(apart.outside().negative > 0);
}

TEST_CASE("InactiveRegions: an empty tree is all outside, memory is asked for", "[vdb][degenerate]") {
    openvdb::initialize();
    const openvdb::FloatTree empty(1.f);
    const InactiveRegions regions(empty, true, {});
    CHECK(regions.isOutside(regions.regionAt({1, 2, 3})));
    CHECK(regions.outside().positive == 0);
    RunContext ctx;
    ctx.maxMemory = 1000;
    const auto grid = test::bandGrid(test::ballField(12), 18, 1);
    CHECK(test::thrownBy([&] { InactiveRegions(grid->tree(), true, ctx); }).code == int(ErrorCode::Memory));
}
