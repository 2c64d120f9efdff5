#include "libvdbsynth/geometry/polygon.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("appendPolygons: triangles and convex quads as they are, under three corners no face",
          "[geometry]") {
    PolygonList list;
    const std::uint32_t corners[] = {0, 1, 2, 3};
    list.add(corners, 2);
    list.add(corners, 3);
    list.add(corners, 4);
    Mesh mesh;
    appendPolygons(mesh, list, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    REQUIRE(mesh.triangles.size() == 1);
    REQUIRE(mesh.quads.size() == 1);
    CHECK(mesh.quads[0] == Quad{0, 1, 2, 3});
}
