#include "libvdbsynth/pipeline/convert/model_wall.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"

using namespace vdbsynth;

namespace {

// A plate 4 voxels thick in voxels of a half, its lower corner at voxel 100,0,0.
LevelSet plate() {
    openvdb::initialize();
    LevelSet model;
    const BrickField field = test::fieldFrom({40, 40, 16}, [&](const Index3& p) {
        const Vec3d q{double(p.x), double(p.y), double(p.z)};
        return float(
            std::clamp(std::max({4 - q.x, q.x - 35, 4 - q.y, q.y - 35, 5.5 - q.z, q.z - 9.5}), -3.0, 3.0));
    });
    model.grid = levelSetFrom(field, 3.f, 0.5, "test");
    model.grid->transform().postTranslate({50, 0, 0});
    model.domain = field.box();
    stampLevelSet(model);
    return model;
}

}  // namespace

TEST_CASE("modelWall: thickness and place in world units", "[pipeline][oracle]") {
    const auto wall = modelWall(plate());
    REQUIRE(wall);
    CHECK(wall->thickness == Approx(2).margin(0.15));
    CHECK(std::min(std::abs(wall->place.z - 2.75), std::abs(wall->place.z - 4.75)) < 0.1);
    CHECK((wall->place.x > 51.9 && wall->place.x < 67.6 && wall->place.y > 1.9));
}

TEST_CASE("modelWall: the bunny's are its ears", "[pipeline][oracle]") {
    const std::string bunny = test::sample("meshes/bunny.off");
    if (bunny.empty()) return;
    ModelOptions options;
    options.resolution = 128;
    const LevelSet model = loadModel(bunny, options);
    const auto wall = modelWall(model);
    REQUIRE(wall);
    const double voxel = voxelSizeOf(*model.grid);
    CHECK(wall->thickness > 0.5 * voxel);
    CHECK(wall->thickness < 12 * voxel);
}

TEST_CASE("modelWall: two parts very far apart are not measured, and a note says so",
          "[pipeline][degenerate]") {
    LevelSet model = plate();
    openvdb::Coord far(1 << 22, 1 << 22, 1 << 22);
    for (auto at = model.grid->cbeginValueOn(); at; ++at)
        if (at.getValue() < 0) model.grid->tree().setValue(at.getCoord() + far, *at);
    test::Said said;
    CHECK_FALSE(modelWall(model, {}, said.ctx));
    CHECK(said.noted("the minimal wall is not measured"));
}

TEST_CASE("modelWall: models without a surface, options out of range", "[pipeline][error]") {
    CHECK(test::thrownBy([] { modelWall({}); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { modelWall(plate(), {2}); }).code == int(ErrorCode::InvalidOption));
    LevelSet flat = plate();
    flat.grid = openvdb::FloatGrid::create(1.5f);
    flat.grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    flat.grid->fill(openvdb::CoordBBox(0, 0, 0, 9, 9, 9), 1.f);
    CHECK(test::thrownBy([&] { modelWall(flat); }).code == int(ErrorCode::EmptyInput));
}
