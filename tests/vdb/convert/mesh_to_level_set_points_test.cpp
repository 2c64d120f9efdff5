#include <catch2/catch.hpp>

#include <cmath>
#include <string>

#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

PointCloud ball(bool normals) {
    PointCloud cloud;
    for (const Vec3f& p : test::sphereMesh(10, 5).points) {
        cloud.points.push_back(p);
        if (normals) cloud.normals.push_back(normalized(p));
    }
    return cloud;
}

double volumeOf(const openvdb::FloatGrid& grid) {
    return solidVoxels(grid) * std::pow(voxelSizeOf(grid), 3);
}

}  // namespace

TEST_CASE("pointsToSolid: points of a ball give the ball, with their normals and without", "[vdb][oracle]") {
    openvdb::initialize();
    for (bool normals : {true, false}) {
        const FloatGridPtr grid = pointsToSolid(ball(normals), 0.5, 3, "ball");
        CHECK(volumeOf(*grid) == Approx(4188.8).epsilon(0.02));
        for (auto it = grid->cbeginValueOn(); it; ++it) {
            const openvdb::Vec3d p = grid->indexToWorld(it.getCoord());
            REQUIRE(double(*it) == Approx(p.length() - 10).margin(0.15));
        }
        CHECK(measureBand(*grid).missingNeighbours == 0);
        CHECK(summarize(levelSetToMesh(*grid)).closedManifold());
    }
}

TEST_CASE("pointsToSolid: a gap is closed, outliers are counted, threads do not matter", "[vdb][property]") {
    openvdb::initialize();
    PointCloud cloud, whole = ball(true);
    for (std::size_t i = 0; i < whole.points.size(); ++i)
        if (whole.points[i].z < 8) {
            cloud.points.push_back(whole.points[i]);
            cloud.normals.push_back(whole.normals[i]);
        }
    cloud.points.push_back({0, 0, 40});
    cloud.normals.push_back({0, 0, 1});
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel, const std::string& text) { said += text; };
    const FloatGridPtr grid = pointsToSolid(cloud, 0.5, 3, "gap.xyz", {}, ctx);
    CHECK(test::contains(said, "gap.xyz: 1 outlier"));
    // The cap above 8 has a volume of 58.6: closed somewhere between flat and round.
    CHECK(volumeOf(*grid) > 4188.8 * 0.95);
    CHECK(volumeOf(*grid) < 4188.8 * 1.02);
    RunContext one;
    one.threads = 1;
    CHECK(levelSetHash(*pointsToSolid(cloud, 0.5, 3, "gap.xyz", {}, one)) == levelSetHash(*grid));
}

TEST_CASE("pointsToSolid: a scan from one side is said to be one, a shell is made of it", "[vdb][property]") {
    openvdb::initialize();
    PointCloud plane;
    for (int x = 0; x < 40; ++x)
        for (int y = 0; y < 40; ++y) plane.points.push_back({float(x) / 2, float(y) / 2, 0.13f});
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Warning) said += text;
    };
    // What it takes for solid is a sheet on one side, as thick as points reach: 2.5 spacings of half a unit.
    const double sheet = volumeOf(*pointsToSolid(plane, 0.5, 3, "plane.xyz", {}, ctx));
    CHECK(sheet > 19.5 * 19.5 * 1.25);
    CHECK(sheet < 22 * 22 * 1.25);
    CHECK(test::contains(said, "`open` shell"));
    SolidOptions shell;
    shell.open = OpenMesh::Shell;
    shell.thickness = 3;
    // 19.5 a side and about 2 beyond each edge.
    const double volume = volumeOf(*pointsToSolid(plane, 0.5, 3, "plane.xyz", shell));
    CHECK(volume > 19.5 * 19.5 * 3);
    CHECK(volume < 23.5 * 23.5 * 3);
}

TEST_CASE("pointsToSolid: too few points, too little memory, cancel", "[vdb][error][cancel]") {
    openvdb::initialize();
    PointCloud few;
    few.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(test::contains(test::thrownBy([&] { pointsToSolid(few, 0.5, 3, "few.xyz"); }).message,
                         "8 are needed"));
    RunContext ctx;
    ctx.maxMemory = 1000000;
    CHECK(test::thrownBy([&] { pointsToSolid(ball(true), 0.005, 3, "b", {}, ctx); }).code ==
          int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    RunContext stopped;
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { pointsToSolid(ball(true), 0.5, 3, "b", {}, stopped); }).code ==
          int(ErrorCode::Cancelled));
}
