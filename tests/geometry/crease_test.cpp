#include "libvdbsynth/geometry/crease.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

VertexSurface face(const Vec3d& normal, const Vec3f& at) {
    VertexSurface surface;
    surface.planes.add(normal, cast<double>(at));
    surface.normal = normal;
    return surface;
}

}  // namespace

TEST_CASE("restoreCreases: an edge between two faces gets a vertex where their planes meet",
          "[geometry][oracle]") {
    // Two triangles whose common edge runs across the crease x = 0, z = 1 between the planes z = 1 and x + z
    // = 1.
    Mesh mesh;
    mesh.points = {{-1, 0, 1}, {0.5f, 0, 0.5f}, {0, -1, 1}, {0, 1, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    const Vec3d top{0, 0, 1}, slope = normalized(Vec3d{1, 0, 1});
    std::vector<VertexSurface> surfaces{face(top, mesh.points[0]), face(slope, mesh.points[1]),
                                        face(top, mesh.points[2]), face(top, mesh.points[3])};
    surfaces[2].rank = surfaces[3].rank = 2;
    CHECK(restoreCreases(mesh, surfaces, 1.2) == 1);
    REQUIRE(mesh.points.size() == 5);
    CHECK(mesh.points[4].x == Approx(0).margin(1e-6));
    CHECK(mesh.points[4].z == Approx(1).margin(1e-6));
    CHECK(mesh.triangles.size() == 4);
    CHECK(surfaces[4].rank == 2);
}

TEST_CASE("restoreCreases: a cut corner comes back, a closed mesh stays closed", "[geometry][property]") {
    // A cube without its corner at (1, 1, 1): its three faces and the triangle that cuts it off.
    Mesh mesh = test::boxMesh({0, 0, 0}, {1, 1, 1});
    const Vec3f cut[3] = {{1, 1, 0.7f}, {1, 0.7f, 1}, {0.7f, 1, 1}};
    const std::uint32_t corner = 7;
    REQUIRE(mesh.points[corner].x + mesh.points[corner].y + mesh.points[corner].z == 3);
    std::vector<Quad> quads;
    mesh.points[corner] = cut[0];
    mesh.points.push_back(cut[1]);
    mesh.points.push_back(cut[2]);
    for (const Quad& q : mesh.quads) {
        if (std::find(q.begin(), q.end(), corner) == q.end()) {
            quads.push_back(q);
            continue;
        }
        // Turned so that the corner comes first; it becomes two vertices, on the edges before and after it.
        Quad r = q;
        while (r[0] != corner) std::rotate(r.begin(), r.begin() + 1, r.end());
        const auto on = [&](std::uint32_t end) {
            const Vec3f& p = mesh.points[end];
            return p.z == 0 ? corner : p.y == 0 ? corner + 1 : corner + 2;
        };
        const std::uint32_t fan[5] = {on(r[3]), on(r[1]), r[1], r[2], r[3]};
        for (int i = 1; i < 4; ++i) mesh.triangles.push_back({fan[0], fan[i], fan[i + 1]});
    }
    mesh.quads = quads;
    mesh.triangles.push_back({corner, corner + 2, corner + 1});
    if (!summarize(mesh).closedManifold()) std::swap(mesh.triangles.back()[0], mesh.triangles.back()[1]);
    REQUIRE(summarize(mesh).closedManifold());
    std::vector<VertexSurface> surfaces(mesh.points.size());
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        surfaces[i].rank = i < corner ? 3 : 2;
        const Vec3f& p = mesh.points[i];
        for (int axis = 0; axis < 3; ++axis) {
            Vec3d normal;
            normal[axis] = 1;
            if (p[axis] == 0 || p[axis] == 1) surfaces[i].planes.add(normal, cast<double>(p));
        }
    }
    CHECK(restoreCreases(mesh, surfaces, 1.2) == 1);
    CHECK(summarize(mesh).closedManifold());
    CHECK(summarize(mesh).signedVolume == Approx(1));
}
