#include "libvdbsynth/vdb/convert/far_grid.h"

#include <catch2/catch.hpp>

#include <cmath>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("wholeVoxels: whole multiples of eight and a rest under half of that", "[vdb][hand]") {
    const WholeVoxels place = wholeVoxels({665187.9, 0, -100}, 0.05);
    CHECK(std::fmod(place.voxels.x, 8) == 0);
    CHECK(place.voxels.x * 0.05 + place.rest.x == Approx(665187.9).epsilon(1e-12));
    CHECK(std::abs(place.rest.x) <= 4 * 0.05);
    CHECK(place.voxels.z == -2000);
    CHECK(wholeVoxels({0, 0, 0}, 0.05).none());
    CHECK_FALSE(place.none());
}

TEST_CASE("meshToSolid: a mesh with an origin is the same solid at its place", "[vdb][oracle]") {
    openvdb::initialize();
    Mesh ball = test::sphereMesh(10, 4);
    const FloatGridPtr near = meshToSolid(ball, 1, 3, "ball");
    for (const double far : {8000.0, 80000000.0}) {
        ball.origin = {far, -far, 0};
        const FloatGridPtr grid = meshToSolid(ball, 1, 3, "ball");
        const bool pure = grid->transform().baseMap()->isType<openvdb::math::UniformScaleMap>();
        CHECK(pure == (far < 1e6));  // the contract: a pure scale as far as floats carry it
        std::size_t off = 0;
        for (auto it = near->cbeginValueOn(); it; ++it) {
            const openvdb::Vec3d world = near->indexToWorld(it.getCoord()) + openvdb::Vec3d(far, -far, 0);
            const openvdb::Coord at = openvdb::Coord::round(grid->worldToIndex(world));
            off += grid->tree().getValue(at) == *it ? 0 : 1;
        }
        CHECK(off == 0);
        CHECK(grid->activeVoxelCount() == near->activeVoxelCount());
        CHECK(solidVoxels(*grid) == solidVoxels(*near));
    }
}

TEST_CASE("nearZero: a far grid's voxels move, their places do not", "[vdb][hand]") {
    openvdb::initialize();
    const FloatGridPtr near = meshToSolid(test::sphereMesh(10, 4), 1, 3, "ball");
    CHECK(nearZero(near) == near);
    const auto far = openvdb::FloatGrid::create(3);
    far->setGridClass(openvdb::GRID_LEVEL_SET);
    const openvdb::Coord by(3 << 20, 0, -(5 << 20));
    for (auto it = near->cbeginValueOn(); it; ++it) far->tree().setValue(it.getCoord() + by, *it);
    const FloatGridPtr moved = nearZero(far);
    REQUIRE(moved != far);
    CHECK(moved->activeVoxelCount() == far->activeVoxelCount());
    const openvdb::CoordBBox box = moved->evalActiveVoxelBoundingBox();
    CHECK(std::abs(box.min().x()) < 64);
    const openvdb::Vec3d world = moved->indexToWorld(openvdb::Coord(0));
    CHECK(moved->tree().getValue(openvdb::Coord(0)) ==
          far->tree().getValue(openvdb::Coord::round(far->worldToIndex(world))));
}

TEST_CASE("requireVoxelSize: OpenVDB's smallest voxel, and what helps", "[vdb][error]") {
    CHECK(test::thrownBy([] { requireVoxelSize(1.5e-5, "part"); }).message.empty());
    const auto refused = test::thrownBy([] { requireVoxelSize(1e-6, "part.stl"); });
    CHECK(refused.code == int(ErrorCode::Unusable));
    CHECK(test::contains(refused.message, "part.stl: voxels of 1e-06"));
    CHECK(test::contains(refused.message, "`unitScale`"));
}
