#include "libvdbsynth/render/packed_mesh.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/makers.h"

#include <cmath>

using namespace vdbsynth;

namespace {

// The other way, as the page's script does it.
struct Unpacked {
    std::vector<Vec3d> places, normals;
    std::vector<Triangle> triangles;
};

Unpacked unpacked(const PackedMesh& packed) {
    Unpacked mesh;
    const auto byte = [](const std::string& bytes, std::size_t i) { return std::uint8_t(bytes.at(i)); };
    for (std::size_t i = 0; i < packed.vertices; ++i) {
        Vec3d p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t at = 6 * i + 2 * std::size_t(axis);
            const double share =
                (byte(packed.positions, at) + 256 * byte(packed.positions, at + 1)) / 65535.0;
            p[axis] = packed.low[axis] + share * (packed.high[axis] - packed.low[axis]);
        }
        mesh.places.push_back(p);
        const double u = std::int8_t(byte(packed.normals, 2 * i)) / 127.0,
                     v = std::int8_t(byte(packed.normals, 2 * i + 1)) / 127.0;
        Vec3d n{u, v, 1 - std::abs(u) - std::abs(v)};
        if (n.z < 0) n = {(1 - std::abs(v)) * (u < 0 ? -1 : 1), (1 - std::abs(u)) * (v < 0 ? -1 : 1), n.z};
        mesh.normals.push_back(normalized(n));
    }
    std::uint32_t met = 0;
    std::size_t at = 0;
    for (std::size_t t = 0; t < packed.triangles; ++t) {
        Triangle triangle;
        for (std::uint32_t& corner : triangle) {
            std::uint32_t value = 0;
            for (int shift = 0;; shift += 7) {
                const std::uint8_t b = byte(packed.corners, at++);
                value |= std::uint32_t(b & 127) << shift;
                if (!(b & 128)) break;
            }
            corner = value == 0 ? met++ : met - value;
        }
        mesh.triangles.push_back(triangle);
    }
    CHECK(at == packed.corners.size());
    CHECK(met == packed.vertices);
    return mesh;
}

}  // namespace

TEST_CASE("packedMesh: a ball comes back, closed, with its normals", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 5), 0.5, 3, "ball");
    const PackedMesh packed = packedMesh(*grid, nullptr, 1000000);
    CHECK(packed.triangles == packed.before);
    CHECK_FALSE(packed.coloured);
    CHECK(packed.colours.empty());
    const Unpacked mesh = unpacked(packed);
    for (std::size_t i = 0; i < mesh.places.size(); ++i) {
        CHECK(length(mesh.places[i]) == Approx(10).margin(0.05));
        CHECK(dot(mesh.normals[i], normalized(mesh.places[i])) > 0.99);
    }
    Mesh check;
    for (const Vec3d& p : mesh.places) check.points.push_back(cast<float>(p));
    check.triangles = mesh.triangles;
    const MeshSummary summary = summarize(check);
    CHECK(summary.closedManifold());
    CHECK(summary.signedVolume == Approx(4188.8).epsilon(0.01));
    // A ball alone sees nearly all of the sky.
    double open = 0;
    for (char c : packed.open) open += std::uint8_t(c);
    CHECK(open / double(packed.open.size()) > 225);
    RunContext one;
    one.threads = 1;
    const PackedMesh again = packedMesh(*grid, nullptr, 1000000, one);
    CHECK(again.positions + again.normals + again.open + again.corners ==
          packed.positions + packed.normals + packed.open + packed.corners);
}

TEST_CASE("packedMesh: few triangles where few are asked for, still a ball", "[vdb]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 5), 0.25, 3, "ball");
    for (const std::size_t most : {8000u, 900u}) {
        const PackedMesh packed = packedMesh(*grid, nullptr, most);
        CHECK(packed.triangles <= most);
        CHECK(packed.triangles > most * 3 / 4);
        CHECK(packed.before > most);
        for (const Vec3d& p : unpacked(packed).places) CHECK(length(p) == Approx(10).margin(0.1));
    }
    CHECK(test::contains(test::thrownBy([&] { packedMesh(*grid, nullptr, 3); }).message, "`most`"));
}

TEST_CASE("packedMesh: colours are the grid's", "[vdb][oracle]") {
    const FloatGridPtr grid = meshToLevelSet(test::boxMesh({0, 0, 0}, {20, 20, 20}), 1, 3, "cube");
    const auto colours = openvdb::Vec3SGrid::create(openvdb::Vec3f(0));
    for (auto value = grid->cbeginValueOn(); value; ++value)
        colours->tree().setValueOn(value.getCoord(), openvdb::Vec3f(0.2f, 0.4f, 0.6f));
    const PackedMesh packed = packedMesh(*grid, colours, 1000000);
    REQUIRE(packed.coloured);
    REQUIRE(packed.colours.size() == 3 * packed.vertices);
    for (std::size_t i = 0; i < packed.colours.size(); i += 3) {
        CHECK(int(std::uint8_t(packed.colours[i])) == 51);
        CHECK(int(std::uint8_t(packed.colours[i + 2])) == 153);
    }
}
