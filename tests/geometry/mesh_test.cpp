#include "libvdbsynth/geometry/mesh.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("summarize: a unit box is closed, manifold, of volume 1 and area 6", "[geometry][oracle]") {
    const MeshSummary s = summarize(test::boxMesh({2, 3, 4}, {3, 4, 5}));
    CHECK(s.closedManifold());
    CHECK(s.signedVolume == Approx(1));
    CHECK(s.area == Approx(6));
    CHECK(s.boxMin.x == 2);
    CHECK(s.boxMax.z == 5);
}

TEST_CASE("summarize: a missing face leaves four open edges, a flipped one four misoriented",
          "[geometry][fast]") {
    Mesh open = test::boxMesh({0, 0, 0}, {1, 1, 1});
    open.quads.pop_back();
    CHECK(summarize(open).openEdges == 4);
    Mesh flipped = test::boxMesh({0, 0, 0}, {1, 1, 1});
    std::swap(flipped.quads[0][0], flipped.quads[0][2]);
    CHECK(summarize(flipped).misorientedEdges == 4);
    Mesh fan = test::boxMesh({0, 0, 0}, {1, 1, 1});
    fan.points.push_back({5, 5, 5});
    fan.triangles.push_back({0, 1, 8});
    CHECK(summarize(fan).nonManifoldEdges == 1);
}

TEST_CASE("triangulated: quads split along the shorter diagonal and keep the volume",
          "[geometry][property]") {
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 2, 3});
    const double volume = summarize(mesh).signedVolume;
    mesh.triangles = triangulated(mesh);
    mesh.quads.clear();
    CHECK(mesh.triangles.size() == 12);
    CHECK(summarize(mesh).signedVolume == Approx(volume));
    CHECK(summarize(mesh).closedManifold());
}
