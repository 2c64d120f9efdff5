#include <catch2/catch.hpp>

#include "libvdbsynth/geometry/mesh.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// Two unit boxes whose points are welded where they coincide.
Mesh weldedPair(const Vec3f& offset) {
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 1});
    const Mesh other = test::boxMesh(offset, offset + Vec3f{1, 1, 1});
    std::vector<std::uint32_t> to;
    for (const Vec3f& p : other.points) {
        std::uint32_t found = std::uint32_t(mesh.points.size());
        for (std::uint32_t i = 0; i < 8; ++i)
            if (length(mesh.points[i] - p) == 0) found = i;
        if (found == mesh.points.size()) mesh.points.push_back(p);
        to.push_back(found);
    }
    for (Quad q : other.quads) {
        for (std::uint32_t& v : q) v = to[v];
        mesh.quads.push_back(q);
    }
    return mesh;
}

}  // namespace

TEST_CASE("separateNonManifold: boxes that share an edge come apart into two closed sheets",
          "[geometry][property]") {
    Mesh mesh = weldedPair({1, 1, 0});
    REQUIRE(summarize(mesh).nonManifoldEdges == 1);
    const double volume = summarize(mesh).signedVolume;
    CHECK(separateNonManifold(mesh, 0.01f) == 2);
    CHECK(summarize(mesh).closedManifold());
    CHECK(summarize(mesh).signedVolume == Approx(volume).epsilon(0.05));
    // Each sheet moved into its own solid: the split points no longer coincide.
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) CHECK(length(mesh.points[i] - mesh.points[j]) > 0.005f);
}

TEST_CASE("separateNonManifold: boxes that share a corner get a vertex each", "[geometry][property]") {
    Mesh mesh = weldedPair({1, 1, 1});
    REQUIRE(mesh.points.size() == 15);
    CHECK(separateNonManifold(mesh, 0.01f) == 1);
    CHECK(mesh.points.size() == 16);
    CHECK(summarize(mesh).closedManifold());
}

TEST_CASE("separateNonManifold: a manifold mesh stays as it is", "[geometry][degenerate]") {
    Mesh mesh = test::sphereMesh(1, 2);
    const std::vector<Vec3f> before = mesh.points;
    CHECK(separateNonManifold(mesh, 0.01f) == 0);
    REQUIRE(mesh.points.size() == before.size());
    for (std::size_t i = 0; i < before.size(); ++i) CHECK(length(mesh.points[i] - before[i]) == 0);
}

TEST_CASE("separateNonManifold: two sides of a wall on the very same place part", "[geometry][property]") {
    // A box squashed flat: front and back share positions, not vertices.
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 0});
    CHECK(separateNonManifold(mesh, 0.01f) == 0);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) CHECK(length(mesh.points[i] - mesh.points[j]) > 0.001f);
}
