#include "libvdbsynth/solid/mesh_parts.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/distance/winding_number.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

Mesh box(float low, float high, bool inward = false) {
    Mesh mesh = test::boxMesh({low, low, low}, {high, high, high});
    mesh.triangles = triangulated(mesh);
    mesh.quads.clear();
    if (inward)
        for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

Mesh joined(const std::vector<Mesh>& meshes) {
    Mesh all;
    for (const Mesh& mesh : meshes) {
        const std::uint32_t first = std::uint32_t(all.points.size());
        all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
        for (const Triangle& t : mesh.triangles)
            all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    return all;
}

// The mesh as orientParts leaves it.
Mesh oriented(const Mesh& mesh) {
    const OrientedParts done = orientParts(mesh, meshParts(mesh));
    return done.mesh ? *done.mesh : mesh;
}

bool isSolidAt(const Mesh& mesh, double x) {
    return WindingNumber(mesh).at({x, x, x}) > 0.5;
}

}  // namespace

TEST_CASE("meshParts: outermost parts are solid whatever their normals", "[solid][hand]") {
    for (const bool inward : {false, true}) {
        const Mesh mesh = joined({box(0, 4, inward), box(10, 12)});
        const MeshParts parts = meshParts(mesh);
        REQUIRE(parts.parts.size() == 2);
        CHECK(parts.parts[0].role == PartRole::Solid);
        CHECK(parts.parts[1].role == PartRole::Solid);
        CHECK(parts.parts[0].signedVolume == Approx(inward ? -64 : 64));
        CHECK(parts.parts[0].area == Approx(96));
        CHECK(parts.parts[1].boxMin.x == 10);
        const OrientedParts done = orientParts(mesh, parts);
        CHECK(done.flipped == (inward ? 1 : 0));
        CHECK(done.mesh.has_value() == inward);
        CHECK(isSolidAt(oriented(mesh), 2));
        CHECK(isSolidAt(oriented(mesh), 11));
    }
}

TEST_CASE("meshParts: a part inside another is a void if its normals oppose, else united", "[solid][hand]") {
    for (const bool outer : {false, true})
        for (const bool inner : {false, true}) {
            const Mesh mesh = joined({box(0, 10, outer), box(3, 7, inner)});
            const MeshParts parts = meshParts(mesh);
            CHECK(parts.parts[1].around == 0);
            CHECK(parts.parts[1].role == (outer == inner ? PartRole::United : PartRole::Cavity));
            CHECK(isSolidAt(oriented(mesh), 1));
            CHECK(isSolidAt(oriented(mesh), 5) == (outer == inner));
            CHECK_FALSE(isSolidAt(oriented(mesh), 11));
        }
}

TEST_CASE("meshParts: solids in voids in solids", "[solid][hand]") {
    const Mesh mesh = joined({box(0, 20), box(2, 18, true), box(4, 16), box(6, 14, true)});
    const PartCounts counts = countParts(meshParts(mesh));
    CHECK(counts.solids == 2);
    CHECK(counts.cavities == 2);
    const std::pair<double, bool> expected[] = {{1, true}, {3, false}, {5, true}, {10, false}, {21, false}};
    for (const auto& [place, solid] : expected) CHECK(isSolidAt(oriented(mesh), place) == solid);
    // All turned over: the same solid.
    Mesh turned = mesh;
    for (Triangle& t : turned.triangles) std::swap(t[1], t[2]);
    for (const auto& [place, solid] : expected) CHECK(isSolidAt(oriented(turned), place) == solid);
}

TEST_CASE("meshParts: a void in a part that is united stays a void", "[solid][hand]") {
    const Mesh mesh = joined({box(0, 20), box(4, 16), box(8, 12, true)});
    const OrientedParts done = orientParts(mesh, meshParts(mesh));
    CHECK(done.removed == 1);
    CHECK(isSolidAt(oriented(mesh), 6));
    CHECK_FALSE(isSolidAt(oriented(mesh), 10));
}

TEST_CASE("meshParts: parts that cross lie in none and unite", "[solid][hand]") {
    const Mesh mesh = joined({box(0, 10), box(5, 15, true)});
    const MeshParts parts = meshParts(mesh);
    CHECK(parts.parts[1].around == -1);
    CHECK(isSolidAt(oriented(mesh), 12));
    CHECK(isSolidAt(oriented(mesh), 2));
}

TEST_CASE("meshParts: a ball with a hole counts as closed, a sheet and a flipped face do not",
          "[solid][hand]") {
    Mesh ball = test::sphereMesh(3, 3);
    ball.triangles = triangulated(ball);
    ball.quads.clear();
    for (Triangle& t : ball.triangles) std::swap(t[1], t[2]);
    Mesh holed = ball;
    holed.triangles.pop_back();
    const MeshParts parts = meshParts(holed);
    REQUIRE(parts.parts.size() == 1);
    CHECK(parts.parts[0].role == PartRole::Solid);
    CHECK(orientParts(holed, parts).flipped == 1);
    Mesh bad = ball;
    std::swap(bad.triangles[7][0], bad.triangles[7][1]);
    CHECK(meshParts(bad).parts[0].role == PartRole::Open);
    Mesh sheet;
    sheet.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 1, 2}};
    CHECK(meshParts(sheet).parts[0].role == PartRole::Open);
    CHECK_FALSE(orientParts(sheet, meshParts(sheet)).mesh.has_value());
}

TEST_CASE("meshParts: a mesh without faces has no parts", "[solid][degenerate]") {
    CHECK(meshParts({}).parts.empty());
    CHECK(orientParts({}, {}).flipped == 0);
}

TEST_CASE("meshParts: many parts, each found in its own shell", "[solid][property]") {
    std::vector<Mesh> meshes;
    for (int i = 0; i < 60; ++i) {
        const float at = float(10 * i);
        meshes.push_back(box(at, at + 8, i % 3 == 0));
        meshes.push_back(box(at + 2, at + 6, i % 3 != 0));
    }
    std::rotate(meshes.begin(), meshes.begin() + 37, meshes.end());
    const Mesh mesh = joined(meshes), done = oriented(mesh);
    const MeshParts parts = meshParts(mesh);
    CHECK(countParts(parts).solids == 60);
    CHECK(countParts(parts).cavities == 60);
    for (int i = 0; i < 60; ++i) {
        CHECK(isSolidAt(done, 10 * i + 1));
        CHECK_FALSE(isSolidAt(done, 10 * i + 4));
    }
}
