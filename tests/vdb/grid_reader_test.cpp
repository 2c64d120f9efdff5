#include "libvdbsynth/vdb/grid_reader.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// Values x + 10 y + 100 z on a block of voxels of size 0.5 that begins at (1, 2, 3) in the world.
template <typename Grid>
typename Grid::Ptr ramp() {
    auto grid = Grid::create();
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y)
            for (int z = 0; z < 8; ++z)
                grid->tree().setValueOn(openvdb::Coord(x, y, z),
                                        typename Grid::ValueType(x + 10 * y + 100 * z));
    auto transform = openvdb::math::Transform::createLinearTransform(0.5);
    transform->postTranslate({1, 2, 3});
    grid->setTransform(transform);
    return grid;
}

Vec3d atVoxel(double x, double y, double z) {
    return Vec3d{1, 2, 3} + Vec3d{x, y, z} * 0.5;
}

}  // namespace

TEST_CASE("scalarReader: reals between voxels, whole numbers and truths at the nearest", "[vdb][oracle]") {
    openvdb::initialize();
    const auto reals = ramp<openvdb::DoubleGrid>();
    const GridReader linear = scalarReader(*reals, GridSampling::Linear, "`guide`");
    CHECK(linear(atVoxel(2.5, 1.25, 3.5)).value.z == Approx(2.5 + 12.5 + 350));
    CHECK(linear(atVoxel(2.5, 1.25, 3.5)).active);
    CHECK_FALSE(linear(atVoxel(20, 1, 3)).active);
    const GridReader nearest = scalarReader(*reals, GridSampling::Nearest, "`guide`");
    CHECK(nearest(atVoxel(2.4, 1.25, 3.4)).value.z == Approx(2 + 10 + 300));
    const auto whole = ramp<openvdb::Int32Grid>();
    CHECK(scalarReader(*whole, GridSampling::Linear, "`guide`")(atVoxel(2.4, 1.25, 3.4)).value.z == 312);
    openvdb::MaskGrid mask;
    mask.tree().setValueOn(openvdb::Coord(1, 1, 1));
    const GridReader truth = scalarReader(mask, GridSampling::Linear, "`guide`");
    CHECK(truth({1.2, 0.9, 1}).value.z == 1);
    CHECK(truth({2, 1, 1}).value.z == 0);
}

TEST_CASE("scalarReader: another kind of grid is refused with its name and kind", "[vdb][errors]") {
    openvdb::initialize();
    auto vectors = openvdb::Vec3SGrid::create();
    vectors->setName("velocity");
    const auto thrown = test::thrownBy([&] { scalarReader(*vectors, GridSampling::Nearest, "`scaleMap`"); });
    CHECK(thrown.code == int(ErrorCode::BadData));
    CHECK(test::contains(thrown.message, "`scaleMap`: grid \"velocity\" (vec3s) holds no scalars"));
}

TEST_CASE("vectorReader, gradientReader: vectors as they are, the slope of a ramp, nothing of other kinds",
          "[vdb][oracle]") {
    openvdb::initialize();
    auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3f(0, 0, 1));
    vectors->tree().setValueOn(openvdb::Coord(0, 0, 0), openvdb::Vec3f(4, 0, 1));
    CHECK(vectorReader(*vectors, GridSampling::Linear)({0.5, 0, 0}).value.x == Approx(2));
    CHECK(vectorReader(*vectors, GridSampling::Nearest)({0.4, 0, 0}).value.x == 4);
    const auto reals = ramp<openvdb::FloatGrid>();
    const Vec3d slope = gradientReader(*reals)(atVoxel(3.3, 4.1, 3.7)).value;
    CHECK(slope.x == Approx(2));  // one a voxel of 0.5
    CHECK(slope.y == Approx(20));
    CHECK(slope.z == Approx(200));
    CHECK_FALSE(bool(vectorReader(*reals, GridSampling::Linear)));
    CHECK_FALSE(bool(gradientReader(*vectors)));
    CHECK_FALSE(bool(gradientReader(*ramp<openvdb::Int32Grid>())));
}
