#include "libvdbsynth/vdb/convert/surface_kept.h"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

struct Said {
    std::vector<std::string> warnings, notes;
    RunContext context() {
        RunContext ctx;
        ctx.onMessage = [this](MessageLevel level, const std::string& text) {
            (level == MessageLevel::Warning ? warnings : notes).push_back(text);
        };
        return ctx;
    }
};

Mesh withBox(Mesh mesh, const Vec3f& low, const Vec3f& high) {
    const Mesh other = test::boxMesh(low, high);
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (const Quad& q : other.quads)
        mesh.quads.push_back({q[0] + first, q[1] + first, q[2] + first, q[3] + first});
    return mesh;
}

}  // namespace

TEST_CASE("meshToSolid: a part thinner than a voxel is said, with the bounds and what helps", "[vdb][hand]") {
    openvdb::initialize();
    // Besides a ball of 10, a plate of 0.3 between two planes of voxels.
    const Mesh mesh = withBox(test::sphereMesh(10, 4), {20, -5, 0.3f}, {30, 5, 0.6f});
    Said said;
    const FloatGridPtr grid = meshToSolid(mesh, 1, 3, "part.stl", {}, said.context());
    REQUIRE(said.warnings.size() == 1);
    // 2 x 100 + 12 of 1256.6 + 212.
    CHECK(test::contains(said.warnings[0], "part.stl: 14 % of its surface"));
    CHECK(test::contains(said.warnings[0], "1 of 2 closed parts"));
    CHECK(test::contains(said.warnings[0], "`resolution`"));
    REQUIRE(said.notes.size() == 1);
    CHECK(test::contains(said.notes[0], "its bounds shrink"));
    CHECK(lostShare(*grid) == Approx(0.144).margin(0.005));
    CHECK(lostShare(*meshToSolid(test::sphereMesh(10, 4), 1, 3, "ball")) == 0);
}

TEST_CASE("meshToSolid: into how many parts a thin solid breaks is said", "[vdb][hand]") {
    openvdb::initialize();
    // Two blocks with a waist of a fifth of a voxel, between the planes of voxels.
    Mesh mesh;
    const float ring[4][2] = {{0, 6}, {20, 0.1f}, {32, 0.1f}, {52, 6}};  // x and half a side
    const float corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (const auto& [x, side] : ring)
        for (const auto& [y, z] : corner) mesh.points.push_back({x, 0.5f + y * side, 0.5f + z * side});
    mesh.quads = {{3, 2, 1, 0}, {12, 13, 14, 15}};
    for (std::uint32_t first = 0; first < 12; first += 4)
        for (std::uint32_t i = 0; i < 4; ++i)
            mesh.quads.push_back({first + i, first + (i + 1) % 4, first + (i + 1) % 4 + 4, first + i + 4});
    Said said;
    meshToSolid(mesh, 1, 3, "waist.obj", {}, said.context());
    REQUIRE(said.warnings.size() + said.notes.size() > 0);
    CHECK(test::contains((said.warnings.empty() ? said.notes : said.warnings)[0],
                         "; what is left breaks into 2 parts"));
}

TEST_CASE("meshToSolid: over half lost is an error, in one line with what helps", "[vdb][error]") {
    openvdb::initialize();
    const Mesh plate = test::boxMesh({0, 0, 0.3f}, {30, 30, 0.6f});
    const auto refused = test::thrownBy([&] { meshToSolid(plate, 1, 3, "plate.stl"); });
    CHECK(refused.code == int(ErrorCode::Unusable));
    CHECK(test::contains(refused.message, "plate.stl: 100 % of its surface"));
    CHECK(test::contains(refused.message, "thinner than a voxel"));
    CHECK(test::contains(refused.message, "`open` shell"));
    // A wall of half a voxel leaves holes in it: near all of its surface something is left, but little
    // volume.
    const Mesh wall = test::boxMesh({0.3f, 0.3f, 0.1f}, {30.3f, 20.3f, 0.55f});
    Mesh turned = wall;
    for (Vec3f& p : turned.points) p = {p.x * 0.8f + p.z * 0.6f, p.y, p.z * 0.8f - p.x * 0.6f};
    CHECK(
        test::contains(test::thrownBy([&] { meshToSolid(turned, 1, 3, "wall"); }).message, "of its volume"));
}

TEST_CASE("requirePointsKept: scattered points are said, most of them are an error", "[vdb][hand]") {
    const BrickField field = test::fieldFrom(
        {32, 32, 32}, [](const Index3& p) { return std::min(3.f, std::max(-3.f, float(p.x) - 12.f)); });
    std::vector<Vec3f> points(20, Vec3f{12, 8, 8});
    Said said;
    requirePointsKept(points, std::vector<float>(20, 0.5f), field, "scan.xyz", said.context());
    CHECK(said.warnings.empty());
    points[3].x = 20;
    requirePointsKept(points, std::vector<float>(20, 0.5f), field, "scan.xyz", said.context());
    REQUIRE(said.warnings.size() == 1);
    CHECK(test::contains(said.warnings[0], "scan.xyz: 5 % of its points"));
    for (Vec3f& p : points) p.x = 20;
    CHECK(test::thrownBy([&] {
              requirePointsKept(points, std::vector<float>(20, 0.5f), field, "scan.xyz");
          }).code == int(ErrorCode::Unusable));
}
