#include "libvdbsynth/vdb/convert/point_grid.h"

#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointCount.h>
#include <catch2/catch.hpp>

#include <map>

#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/makers.h"
#include "tests/support/point_shapes.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

namespace {

PointCloud cloud() {
    const test::PointShape shape = test::spiralSphere(500, 3);
    PointCloud made;
    made.points = shape.point;
    made.normals = shape.normal;
    made.origin = {10, 0, 0};
    Attribute colour{"Cd", 3, {}}, number{"number", 1, {}}, uv{"uv", 2, {}};
    for (std::size_t i = 0; i < made.points.size(); ++i) {
        colour.values.insert(colour.values.end(), {float(i), 1, 2});
        number.values.push_back(float(i));
        uv.values.insert(uv.values.end(), {3, 4});
    }
    made.attributes = {colour, number, uv};
    return made;
}

}  // namespace

TEST_CASE("pointGrid: a file of it holds every point with its attributes", "[vdb]") {
    const test::TemporaryFolder folder;
    const PointCloud from = cloud();
    writeVdb(folder.path("p.vdb"), {pointGrid(from, 0.5)}, {});
    const auto grids = readVdbGrids(folder.path("p.vdb"));
    REQUIRE(grids.size() == 1);
    const auto grid = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(grids[0]);
    REQUIRE(grid);
    CHECK(openvdb::points::pointCount(grid->tree()) == 500);
    std::map<int, Vec3f> places;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<openvdb::Vec3f> place(leaf->constAttributeArray("P"));
        const openvdb::points::AttributeHandle<float> number(leaf->constAttributeArray("number"));
        const openvdb::points::AttributeHandle<openvdb::Vec3f> normal(leaf->constAttributeArray("N")),
            colour(leaf->constAttributeArray("Cd")), uv(leaf->constAttributeArray("uv"));
        for (auto i = leaf->beginIndexOn(); i; ++i) {
            const auto world = grid->indexToWorld(i.getCoord().asVec3d() + openvdb::Vec3d(place.get(*i)));
            const int n = int(number.get(*i));
            places[n] = {float(world[0] - 10), float(world[1]), float(world[2])};
            CHECK(colour.get(*i)[0] == float(n));
            CHECK(uv.get(*i) == openvdb::Vec3f(3, 4, 0));
            CHECK(normal.get(*i)[2] == from.normals[std::size_t(n)].z);
        }
    }
    REQUIRE(places.size() == 500);
    for (const auto& [n, at] : places) CHECK(length(at - from.points[std::size_t(n)]) < 1e-5f);
}

TEST_CASE("pointGrid: bad voxels, no points and far points are errors, coinciding ones are kept",
          "[vdb][error]") {
    CHECK(test::thrownBy([] { pointGrid(cloud(), 0); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { pointGrid({}, 1); }).code == int(ErrorCode::EmptyInput));
    PointCloud far;
    far.points = {{1e20f, 0, 0}};
    CHECK(test::thrownBy([&] { pointGrid(far, 1); }).code == int(ErrorCode::Unusable));
    PointCloud same;
    same.points.assign(5, Vec3f{1, 1, 1});
    const auto grid = openvdb::gridPtrCast<openvdb::points::PointDataGrid>(pointGrid(same, 1));
    CHECK(openvdb::points::pointCount(grid->tree()) == 5);
}
