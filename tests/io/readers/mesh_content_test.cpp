#include "libvdbsynth/io/readers/mesh_content.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

MeshContent oneTriangle() {
    MeshContent content;
    content.points = {{NAN, 0, 0}, {1e6, 0, 0}, {1e6 + 1, 0, 0}, {1e6, 1, 0}};
    const std::uint32_t corners[] = {1, 2, 3};
    content.polygons.add(corners, 3);
    content.attributes = {{"density", 1, {9, 1, 2, 3}}};
    return content;
}

}  // namespace

TEST_CASE("meshOf: points that are not finite and that no face uses are left out", "[io][hand]") {
    const Mesh mesh = meshOf("m.ply", oneTriangle(), {});
    REQUIRE(mesh.points.size() == 3);
    CHECK(mesh.triangles[0] == Triangle{0, 1, 2});
    CHECK(mesh.attributes[0].values == std::vector<float>{1, 2, 3});
    CHECK(mesh.origin.x == 1000001);
    CHECK(mesh.points[1].x == 0);
}

TEST_CASE("meshOf: a face with a bad corner is an error that names it", "[io][error]") {
    const auto refused = [](MeshContent content) {
        return test::thrownBy([&] { meshOf("m.ply", content, {}); });
    };
    MeshContent bad = oneTriangle();
    bad.polygons.corners[1] = 0;
    CHECK(test::contains(refused(bad).message, "m.ply: a face uses vertex 0"));
    CHECK(refused(bad).code == int(ErrorCode::BadData));
    bad.polygons.corners[1] = 4;
    CHECK(test::contains(refused(bad).message, "vertex 4 of 4"));
    CHECK(refused({}).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("meshOf: faces that cross themselves and faces of two corners are said", "[io][hand]") {
    MeshContent content;
    content.points = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::uint32_t corners[] = {0, 1, 2, 3};
    content.polygons.add(corners, 4);
    content.polygons.add(corners, 2);
    content.polygons.add(corners, 3);
    std::vector<std::string> said;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        said.push_back((level == MessageLevel::Warning ? "warning " : "note ") + text);
    };
    CHECK(meshOf("m.off", content, ctx).faceCount() == 2);
    REQUIRE(said.size() == 2);
    CHECK(said[0] == "note m.off: 1 face with fewer than three corners left out");
    CHECK(test::contains(said[1], "warning m.off: 1 of 3 faces cross themselves"));
}
