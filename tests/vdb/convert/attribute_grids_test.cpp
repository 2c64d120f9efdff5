#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/attribute_grids.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// A field that is linear in space, so that interpolation has to be exact but for where faces bend.
Attributes linearAttributes(const std::vector<Vec3f>& points) {
    Attribute colour{"Cd", 3, {}}, heat{"heat", 1, {}}, uv{"uv", 2, {}};
    for (const Vec3f& p : points) {
        colour.values.insert(colour.values.end(), {p.x * 0.1f, p.y * 0.1f, 0.5f});
        heat.values.push_back(2 * p.z + 1);
        uv.values.insert(uv.values.end(), {p.x, p.y});
    }
    return {colour, heat, uv};
}

}  // namespace

TEST_CASE("attributesToGrids, gridsToAttributes: a linear attribute survives mesh to grid to mesh",
          "[vdb][property]") {
    openvdb::initialize();
    Mesh mesh = test::sphereMesh(5, 4);
    mesh.attributes = linearAttributes(mesh.points);
    const FloatGridPtr levelSet = meshToLevelSet(mesh, 0.25, 3, "sphere");
    const std::vector<GridPtr> grids = attributesToGrids(mesh, *levelSet);
    REQUIRE(grids.size() == 3);
    CHECK(grids[0]->getName() == "Cd");
    CHECK(grids[0]->isType<openvdb::Vec3SGrid>());
    CHECK(grids[1]->isType<openvdb::FloatGrid>());
    for (const GridPtr& grid : grids) CHECK(grid->activeVoxelCount() == levelSet->activeVoxelCount());
    const Mesh made = levelSetToMesh(*levelSet);
    const Attributes back = gridsToAttributes(grids, made.points, {});
    REQUIRE(back.size() == 3);
    CHECK(back[2].width == 2);
    for (std::size_t i = 0; i < made.points.size(); ++i) {
        const Vec3f& p = made.points[i];
        REQUIRE(findAttribute(back, "heat")->values[i] == Approx(2 * p.z + 1).margin(0.12));
        REQUIRE(findAttribute(back, "Cd")->values[3 * i] == Approx(p.x * 0.1).margin(0.01));
        REQUIRE(findAttribute(back, "Cd")->values[3 * i + 2] == Approx(0.5));
        REQUIRE(findAttribute(back, "uv")->values[2 * i + 1] == Approx(p.y).margin(0.06));
    }
}

TEST_CASE("attributesToGrids: of points, and the same bits for any number of threads",
          "[vdb][property][threads]") {
    openvdb::initialize();
    const Mesh mesh = test::sphereMesh(5, 4);
    PointCloud cloud;
    for (const Vec3f& p : mesh.points) {
        cloud.points.push_back(p);
        cloud.normals.push_back(normalized(p));
    }
    cloud.attributes = linearAttributes(cloud.points);
    const FloatGridPtr levelSet = meshToLevelSet(mesh, 0.5, 3, "sphere");
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    const auto a = openvdb::GridBase::grid<openvdb::FloatGrid>(attributesToGrids(cloud, *levelSet, one)[1]);
    const auto b = openvdb::GridBase::grid<openvdb::FloatGrid>(attributesToGrids(cloud, *levelSet, two)[1]);
    for (auto voxel = a->cbeginValueOn(); voxel; ++voxel) {
        REQUIRE(b->tree().getValue(voxel.getCoord()) == *voxel);
        const openvdb::Vec3d p = a->indexToWorld(voxel.getCoord());
        REQUIRE(double(*voxel) == Approx(2 * p.z() * 5 / p.length() + 1).margin(0.8));
    }
}

TEST_CASE("gridsToAttributes: kinds of grid, inactive places, level sets are passed over", "[vdb][fast]") {
    openvdb::initialize();
    const auto count = openvdb::Int32Grid::create(-1);
    count->setName("count");
    count->tree().setValue({0, 0, 0}, 7);
    const auto other = openvdb::FloatGrid::create(3);
    other->setName("shell");
    other->setGridClass(openvdb::GRID_LEVEL_SET);
    const auto text = openvdb::MaskGrid::create(false);
    text->setName("mask");
    const Attributes made =
        gridsToAttributes({count, other, text}, {{0.2f, 0, 0}, {0.9f, 0.9f, 0.9f}, {20, 0, 0}}, {});
    REQUIRE(made.size() == 1);
    CHECK(made[0].values == std::vector<float>{7, 7, -1});
}
