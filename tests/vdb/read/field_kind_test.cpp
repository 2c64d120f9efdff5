#include "libvdbsynth/vdb/read/field_kind.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/vdb/read/fields.h"

using namespace vdbsynth;
using test::ballField;
using test::bandGrid;
using test::boxField;
using test::denseGrid;

TEST_CASE("kindOf: fields of no class are told by their slopes", "[vdb][fast]") {
    CHECK(kindOf(*denseGrid(ballField(8), 12, 0.1, 0)) == FieldKind::Distances);
    CHECK(kindOf(*denseGrid(boxField({9, 5, 3}), 12, 0.1, 0)) == FieldKind::Distances);
    // In voxels, and turned.
    CHECK(kindOf(*denseGrid([](const openvdb::Vec3d& p) { return 10 * (p.length() - 8); }, 12, 0.1, 0)) ==
          FieldKind::Distances);
    CHECK(kindOf(*denseGrid([](const openvdb::Vec3d& p) { return 8 - p.length(); }, 12, 0.1, 5)) ==
          FieldKind::Distances);
    // Clamped within a voxel, as depth cameras give them.
    CHECK(kindOf(*denseGrid(
              [](const openvdb::Vec3d& p) { return std::max(-2.0, std::min(2.0, p.length() - 8)); }, 12, 0.1,
              0)) == FieldKind::Distances);
}

TEST_CASE("kindOf: numbers of two signs are no distances", "[vdb][fast]") {
    const auto noise = [](const openvdb::Vec3d& p) {
        return Random(3, std::uint64_t(p[0] * 10000 + p[1] * 100 + p[2] + 1e6)).uniform(-10, 10);
    };
    CHECK(kindOf(*denseGrid(noise, 12, 0.1, 5)) == FieldKind::Density);
    const auto square = [](const openvdb::Vec3d& p) { return p.lengthSqr() - 64; };
    CHECK(kindOf(*denseGrid(square, 12, 0.1, 0)) == FieldKind::Density);
    CHECK(kindOf(*denseGrid([](const openvdb::Vec3d& p) { return p.length(); }, 12, 0.1, 0)) ==
          FieldKind::Density);
    CHECK(kindOf(*openvdb::FloatGrid::create(0.f)) == FieldKind::Density);
}

TEST_CASE("kindOf: a class decides where there is one", "[vdb][fast]") {
    const auto grid = denseGrid(ballField(8), 12, 0.1, 0);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    CHECK(kindOf(*grid) == FieldKind::Density);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    CHECK(kindOf(*grid) == FieldKind::LevelSet);
}

TEST_CASE("kindOf: a band under a voxel wide is told by its form", "[vdb][fast]") {
    test::Band band;
    band.outside = band.inside = band.background = 0.6;
    band.interior = -0.6;
    const auto grid = bandGrid(ballField(8), 12, 0.1, band);
    grid->setGridClass(openvdb::GRID_UNKNOWN);
    CHECK(kindOf(*grid) == FieldKind::Distances);
}

TEST_CASE("distanceFitOf: slopes in world units of any linear transform", "[vdb][property]") {
    const auto grid = denseGrid(ballField(8), 12, 0.1, 0);
    CHECK(distanceFitOf(*grid).slope == Approx(1).epsilon(0.02));
    CHECK(distanceFitOf(*grid).worldShare > 0.95);
    CHECK(distanceFitOf(*grid).voxelShare < 0.05);
    grid->transform().postRotate(0.6, openvdb::math::X_AXIS);
    CHECK(distanceFitOf(*grid).worldShare > 0.95);
    grid->transform().postScale({1, 1, 2});
    CHECK(distanceFitOf(*grid).worldShare < 0.6);
    RunContext one;
    one.threads = 1;
    CHECK(distanceFitOf(*grid, one).slope == distanceFitOf(*grid).slope);
    CHECK(distanceFitOf(*openvdb::FloatGrid::create(0.f)).measured == 0);
}
