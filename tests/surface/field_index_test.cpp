#include "libvdbsynth/surface/field_index.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/points/surface_sites.h"
#include "libvdbsynth/surface/direction_field.h"
#include "tests/support/makers.h"
#include "tests/support/shapes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <utility>

using namespace vdbsynth;

namespace {

std::vector<Vec3f> normalsOf(const Mesh& mesh) {
    std::vector<Vec3f> normals(mesh.points.size());
    for (const Triangle& t : triangulated(mesh)) {
        const Vec3f n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
        for (std::uint32_t corner : t) normals[corner] = normals[corner] + n;
    }
    for (Vec3f& n : normals) n = normalized(n);
    return normals;
}

Mesh meshOf(const BrickField& field) {
    return zeroLevel(field, field.box(), Facing::Outward);
}

// Sum of the indices of the smoothest field on a closed mesh, and how many triangles have one.
std::pair<int, int> indexSum(const Mesh& mesh, double spacing) {
    const std::vector<Vec3f> normals = normalsOf(mesh);
    const SurfaceSites sites = sitesOfPoints(mesh.points, normals, 8);
    const DirectionField field = smoothDirectionField(sites, sitePlaces(sites, 1.5 * spacing), {0, 0, 1});
    const std::vector<int> indices = fieldIndices(mesh, normals, field.tangent);
    int singular = 0;
    for (int i : indices) singular += i != 0;
    return {std::accumulate(indices.begin(), indices.end(), 0), singular};
}

// A fan of triangles around the origin, and a field at its points.
int fanIndex(const std::function<Vec3f(double)>& fieldAt) {
    constexpr int kCorners = 12;
    Mesh mesh;
    std::vector<Vec3f> normals, tangents;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * 3.141592653589793 * i / kCorners;
        mesh.points.push_back({float(std::cos(angle)), float(std::sin(angle)), 0});
        normals.push_back({0, 0, 1});
        tangents.push_back(fieldAt(angle));
    }
    // The centre's own direction is arbitrary: one of the triangles at it has the index.
    mesh.points.push_back({0, 0, 0});
    normals.push_back({0, 0, 1});
    tangents.push_back(normalized(Vec3f{0.9f, 0.1f, 0}));
    for (std::uint32_t i = 0; i < kCorners; ++i) mesh.triangles.push_back({i, (i + 1) % kCorners, kCorners});
    const std::vector<int> indices = fieldIndices(mesh, normals, tangents);
    return std::accumulate(indices.begin(), indices.end(), 0);
}

}  // namespace

TEST_CASE("fieldIndices: a source, a vortex, a saddle and a uniform field in the plane") {
    const auto at = [](double a) { return Vec3f{float(std::cos(a)), float(std::sin(a)), 0}; };
    CHECK(fanIndex([&](double a) { return at(a); }) == 1);
    CHECK(fanIndex([&](double a) { return at(a + 1.5707963); }) == 1);
    CHECK(fanIndex([&](double a) { return at(-a); }) == -1);
    CHECK(fanIndex([&](double a) { return at(2 * a); }) == 2);
    CHECK(fanIndex([&](double) { return at(0.3); }) == 0);
}

TEST_CASE("fieldIndices: sum to the Euler characteristic of meshed level sets") {
    const Mesh ball = meshOf(*test::sphereField(48, 17));
    CHECK(indexSum(ball, 0.7).first == 2);
    CHECK(indexSum(ball, 0.7).second <= 6);
    const auto torus = test::shapeField({64, 64, 32}, [](const Vec3d& p) {
        const double x = p.x - 32, y = p.y - 32, z = p.z - 16;
        const double ring = std::sqrt(x * x + y * y) - 18;
        return std::sqrt(ring * ring + z * z) - 7;
    });
    CHECK(indexSum(meshOf(*torus), 0.7).first == 0);
}

TEST_CASE("fieldIndices: sum to the Euler characteristic of a mesh with three holes") {
    const char* samples = std::getenv("VDBSYNTH_SAMPLES");
    const std::string path = std::string(samples ? samples : "") + "/meshes/3holes.off";
    if (!samples || !std::filesystem::exists(path)) {
        WARN("skipped: no sample files");
        return;
    }
    const Mesh mesh = readMesh(path);
    CHECK(indexSum(mesh, 0.02).first == -4);
}

TEST_CASE("fieldIndices: arrays of other lengths, no faces") {
    Mesh mesh;
    mesh.points = {{0, 0, 0}};
    CHECK(test::thrownBy([&] { fieldIndices(mesh, {}, {{1, 0, 0}}); }).code == int(ErrorCode::ShapeMismatch));
    CHECK(fieldIndices(mesh, {{0, 0, 1}}, {{1, 0, 0}}).empty());
}
