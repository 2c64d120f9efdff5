#include "libvdbsynth/render/surface_colours.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("colourGridOf: Cd first, in any case, vectors only", "[render]") {
    openvdb::initialize();
    const auto named = [](const openvdb::GridBase::Ptr& grid, const char* name) {
        grid->setName(name);
        return grid;
    };
    const GridPtr density = named(openvdb::FloatGrid::create(), "Cd");
    const GridPtr colour = named(openvdb::Vec3DGrid::create(), "Color");
    const GridPtr cd = named(openvdb::Vec3SGrid::create(), "cd");
    CHECK(colourGridOf({density, colour, cd}) == cd);
    CHECK(colourGridOf({density, colour}) == colour);
    CHECK_FALSE(colourGridOf({density, nullptr}));
    CHECK_FALSE(colourGridOf({}));
}

TEST_CASE("SurfaceColours: trilinear among the active voxels", "[render][oracle]") {
    const auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(9));
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 8; ++i)
        accessor.setValueOn({i >> 2, i >> 1 & 1, i & 1},
                            openvdb::Vec3f(float(i >> 2), float(i >> 1 & 1), 0.25f));
    SurfaceColours colours(grid);
    Vec3f colour;
    REQUIRE(colours.at({0.15, 0.35, 0.2}, colour));
    CHECK(double(colour.x) == Approx(0.3).margin(1e-4));
    CHECK(double(colour.y) == Approx(0.7).margin(1e-4));
    CHECK(double(colour.z) == Approx(0.25).margin(1e-4));
    // Half beyond the active voxels only these count, not the background of 9.
    REQUIRE(colours.at({0.7, 0.0, 0.0}, colour));
    CHECK(double(colour.x) == Approx(1).margin(1e-4));
    CHECK_FALSE(colours.at({5, 5, 5}, colour));
    SurfaceColours copy(colours);
    CHECK(copy.at({0.15, 0.35, 0.2}, colour));
}

TEST_CASE("SurfaceColours: other grids are refused", "[render][error]") {
    CHECK(test::contains(test::thrownBy([] { SurfaceColours{openvdb::FloatGrid::create()}; }).message,
                         "`colours`"));
    CHECK(test::thrownBy([] { SurfaceColours{nullptr}; }).code == int(ErrorCode::InvalidOption));
}
