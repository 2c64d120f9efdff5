#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

double volumeOf(const openvdb::FloatGrid& grid) {
    return solidVoxels(grid) * std::pow(voxelSizeOf(grid), 3);
}

// The faces of a sphere below a height.
Mesh bowl(float radius, float height) {
    const Mesh ball = test::sphereMesh(double(radius), 5);
    Mesh mesh;
    mesh.points = ball.points;
    for (const Triangle& t : ball.triangles)
        if (std::max({ball.points[t[0]].z, ball.points[t[1]].z, ball.points[t[2]].z}) < height)
            mesh.triangles.push_back(t);
    return mesh;
}

Mesh sheet(float side) {
    Mesh mesh;
    mesh.points = {{0, 0, 0.13f}, {side, 0, 0.13f}, {side, side, 0.13f}, {0, side, 0.13f}};
    mesh.quads = {{0, 1, 2, 3}};
    return mesh;
}

}  // namespace

TEST_CASE("meshToSolid: an opening is closed about where it is flat", "[vdb][property]") {
    openvdb::initialize();
    const Mesh open = bowl(10, 6);
    std::string said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        if (level == MessageLevel::Warning) said += text;
    };
    const FloatGridPtr grid = meshToSolid(open, 0.5, 3, "bowl.obj", {}, ctx);
    CHECK(test::contains(said, "bowl.obj: "));
    CHECK(test::contains(said, "open edges"));
    // A ball less its cap of height 4: 4188.8 - pi 16 (10 - 4/3).
    CHECK(volumeOf(*grid) == Approx(4188.8 - 435.6).epsilon(0.04));
    const BandQuality band = measureBand(*grid);
    CHECK(band.gradientErrorMean < 0.05);
    CHECK(band.missingNeighbours == 0);
    CHECK(summarize(levelSetToMesh(*grid)).closedManifold());
}

TEST_CASE("meshToSolid: shuffled vertices, turned faces and overlapping parts make the solid they show",
          "[vdb][property]") {
    openvdb::initialize();
    const Mesh ball = test::sphereMesh(10, 4);
    const double volume = volumeOf(*meshToSolid(ball, 0.5, 3, "ball"));
    Mesh soup;
    for (std::size_t i = 0; i < ball.triangles.size(); ++i) {
        const std::uint32_t first = std::uint32_t(soup.points.size());
        for (std::uint32_t corner : ball.triangles[i]) soup.points.push_back(ball.points[corner]);
        const std::uint32_t odd = std::uint32_t(i % 2);
        soup.triangles.push_back({first, first + 1 + odd, first + 2 - odd});
    }
    CHECK(volumeOf(*meshToSolid(soup, 0.5, 3, "soup")) == Approx(volume));
    // Two open bowls that overlap, the second turned upside down: their union.
    Mesh both = bowl(10, 5);
    const std::uint32_t shift = std::uint32_t(both.points.size());
    Mesh other = bowl(10, 5);
    for (Vec3f& p : other.points) p = {p.x, -p.y, -p.z};
    both.points.insert(both.points.end(), other.points.begin(), other.points.end());
    for (const Triangle& t : other.triangles)
        both.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
    CHECK(volumeOf(*meshToSolid(both, 0.5, 3, "both")) == Approx(volume).epsilon(0.03));
}

TEST_CASE("meshToSolid: a ball whose faces are all given from both sides is a ball", "[vdb][property]") {
    openvdb::initialize();
    const Mesh ball = test::sphereMesh(10, 4);
    Mesh twice = ball;
    for (const Triangle& t : ball.triangles) twice.triangles.push_back({t[1], t[0], t[2]});
    CHECK(volumeOf(*meshToSolid(twice, 0.5, 3, "twice")) ==
          Approx(volumeOf(*meshToSolid(ball, 0.5, 3, "ball"))).epsilon(0.01));
}

TEST_CASE("meshToSolid: a box with some of its faces given twice has a whole band", "[vdb][property]") {
    openvdb::initialize();
    Mesh box = test::boxMesh({0.1f, 0.2f, 0.3f}, {10.1f, 8.2f, 6.3f});
    const Mesh once = box;
    box.triangles.push_back(triangulated(once)[0]);
    box.triangles.push_back({triangulated(once)[0][1], triangulated(once)[0][0], triangulated(once)[0][2]});
    const FloatGridPtr grid = meshToSolid(box, 0.5, 3, "box");
    CHECK(volumeOf(*grid) == Approx(480).epsilon(0.05));
    CHECK(measureBand(*grid).missingNeighbours == 0);
}

TEST_CASE("meshToSolid: a cavity stays a cavity", "[vdb][property]") {
    openvdb::initialize();
    Mesh hollow = test::sphereMesh(10, 5);
    const Mesh inner = test::sphereMesh(6, 4);
    const std::uint32_t shift = std::uint32_t(hollow.points.size());
    hollow.points.insert(hollow.points.end(), inner.points.begin(), inner.points.end());
    for (const Triangle& t : inner.triangles)
        hollow.triangles.push_back({t[1] + shift, t[0] + shift, t[2] + shift});
    const FloatGridPtr grid = meshToSolid(hollow, 0.5, 3, "hollow");
    CHECK(volumeOf(*grid) == Approx(4188.8 - 904.8).epsilon(0.02));
    CHECK(grid->tree().getValue(openvdb::Coord(0, 0, 0)) > 0);
}

TEST_CASE("meshToSolid: same bits for any number of threads", "[vdb][determinism]") {
    openvdb::initialize();
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    CHECK(levelSetHash(*meshToSolid(bowl(10, 6), 0.6, 3, "b", {}, one)) ==
          levelSetHash(*meshToSolid(bowl(10, 6), 0.6, 3, "b", {}, two)));
}

TEST_CASE("meshToSolid: a sheet is refused with what helps, and helped by it", "[vdb][error]") {
    openvdb::initialize();
    const test::Thrown thrown = test::thrownBy([&] { meshToSolid(sheet(20), 0.5, 3, "s.obj"); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "s.obj: a sheet with 4 open edges"));
    CHECK(test::contains(thrown.message, "`open` shell and a `thickness`"));
    SolidOptions shell;
    shell.open = OpenMesh::Shell;
    CHECK(test::contains(test::thrownBy([&] { meshToSolid(sheet(20), 0.5, 3, "s", shell); }).message,
                         "`thickness`"));
    shell.thickness = 0.1;
    CHECK(test::contains(test::thrownBy([&] { meshToSolid(sheet(20), 0.5, 3, "s", shell); }).message,
                         "at least a voxel"));
    shell.thickness = 3;
    const FloatGridPtr grid = meshToSolid(sheet(20), 0.5, 3, "s", shell);
    // A plate with round edges: area, half a cylinder along each side, a ball for the corners.
    const double pi = 3.14159265358979;
    CHECK(volumeOf(*grid) == Approx(400 * 3 + 4 * 20 * pi * 2.25 / 2 + 4 * pi * 3.375 / 3).epsilon(0.02));
    CHECK(measureBand(*grid).gradientErrorMean < 0.05);
}

TEST_CASE("meshToSolid: cancel and too little memory", "[vdb][error][cancel]") {
    openvdb::initialize();
    RunContext ctx;
    ctx.maxMemory = 1000000;
    CHECK(test::thrownBy([&] { meshToSolid(bowl(10, 6), 0.01, 3, "b", {}, ctx); }).code ==
          int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    RunContext stopped;
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { meshToSolid(bowl(10, 6), 0.5, 3, "b", {}, stopped); }).code ==
          int(ErrorCode::Cancelled));
}
