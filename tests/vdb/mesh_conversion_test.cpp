#include "libvdbsynth/vdb/mesh_conversion.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/vdb/bricks.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("meshToLevelSet: a sphere's distances are a sphere's", "[vdb][oracle]") {
    openvdb::initialize();
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.5, 3, "sphere");
    CHECK(voxelSizeOf(*grid) == 0.5);
    CHECK(grid->background() == 1.5f);
    for (auto it = grid->cbeginValueOn(); it; ++it) {
        const openvdb::Vec3d p = grid->indexToWorld(it.getCoord());
        REQUIRE(double(*it) == Approx(p.length() - 10).margin(0.06));
    }
    CHECK(solidVoxels(*grid) * 0.125 == Approx(4188.8).epsilon(0.01));
}

TEST_CASE("meshToLevelSet: an open mesh is refused with its open edges counted", "[vdb][error]") {
    Mesh open = test::sphereMesh(10, 3);
    open.triangles.resize(open.triangles.size() / 3);
    const test::Thrown thrown = test::thrownBy([&] { meshToLevelSet(open, 0.5, 3, "half.obj"); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "half.obj: "));
    CHECK(test::contains(thrown.message, "open edges; close the mesh"));
}

TEST_CASE("meshToLevelSet: options out of range, too much memory, cancel", "[vdb][error][cancel]") {
    const Mesh sphere = test::sphereMesh(10, 3);
    CHECK(test::contains(test::thrownBy([&] { meshToLevelSet(sphere, 0, 3, "s"); }).message, "`voxelSize`"));
    CHECK(test::contains(test::thrownBy([&] { meshToLevelSet(sphere, 1, 1, "s"); }).message, "`halfWidth`"));
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    CHECK(test::thrownBy([&] { meshToLevelSet(sphere, 1e-4, 3, "s", ctx); }).code == int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { meshToLevelSet(sphere, 1, 3, "s", ctx); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("levelSetToMesh: closed, manifold, outward, on the zero level", "[vdb][property]") {
    for (double adaptivity : {0.0, 0.3, 1.0}) {
        INFO(adaptivity);
        const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 5), 0.5, 3, "sphere");
        MeshingOptions options;
        options.adaptivity = adaptivity;
        const Mesh mesh = levelSetToMesh(*grid, options);
        const MeshSummary s = summarize(mesh);
        CHECK(s.closedManifold());
        CHECK(s.signedVolume == Approx(4188.8).epsilon(adaptivity > 0 ? 0.2 : 0.02));
        if (adaptivity > 0) continue;
        for (const Vec3f& p : mesh.points) REQUIRE(double(length(p)) == Approx(10).margin(0.02));
    }
    const auto empty = openvdb::FloatGrid::create(3.f);
    CHECK(test::thrownBy([&] { levelSetToMesh(*empty); }).code == int(ErrorCode::EmptyInput));
    MeshingOptions bad;
    bad.adaptivity = 2;
    CHECK(test::contains(test::thrownBy([&] { levelSetToMesh(*empty, bad); }).message, "`adaptivity`"));
}

TEST_CASE("levelSetToMesh: sheets that touch at voxel edges come out closed and manifold",
          "[vdb][property]") {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        // Random signs at every voxel: as many ambiguous cells as there can be.
        const BrickField field = test::fieldFrom({14, 14, 14}, [&](const Index3& p) {
            const bool edge = p.x == 0 || p.y == 0 || p.z == 0 || p.x == 13 || p.y == 13 || p.z == 13;
            return edge ? 1.f
                        : float(Random(seed, std::uint64_t((p.x * 100 + p.y) * 100 + p.z)).uniform(-1, 1));
        });
        Mesh mesh = levelSetToMesh(*scatterBricks(field, {0, 0, 0}, 1.f, 3.f));
        const MeshSummary s = summarize(mesh);
        CHECK(s.openEdges == 0);
        CHECK(s.nonManifoldEdges == 0);
        CHECK(s.misorientedEdges == 0);
    }
}

TEST_CASE("levelSetToPoints: even spacing, outward unit normals, repeats by seed", "[vdb][property]") {
    const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 5), 0.5, 3, "sphere");
    PointOptions options;
    options.spacing = 2;
    const PointCloud cloud = levelSetToPoints(*grid, options);
    REQUIRE(cloud.points.size() == cloud.normals.size());
    // Darts end at 0.547 of the area under disks of half the spacing's radius (random sequential adsorption).
    CHECK(double(cloud.points.size()) > 0.9 * 0.547 * 1256.6 / 0.7854);
    double farthest = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        CHECK(double(length(cloud.points[i])) == Approx(10).margin(0.05));
        CHECK(double(dot(cloud.normals[i], normalized(cloud.points[i]))) > 0.99);
        float nearest = 1e9f;
        for (std::size_t j = 0; j < cloud.points.size(); ++j)
            if (j != i) nearest = std::min(nearest, length(cloud.points[i] - cloud.points[j]));
        REQUIRE(nearest >= 0.999f);
        farthest = std::max(farthest, double(nearest));
    }
    CHECK(farthest < 2.0);
    CHECK(levelSetToPoints(*grid, options).points.size() == cloud.points.size());
    options.spacing = 0.1;
    CHECK(test::contains(test::thrownBy([&] { levelSetToPoints(*grid, options); }).message, "`spacing`"));
}

TEST_CASE("meshToLevelSet, levelSetToMesh: same bits for any number of threads", "[vdb][determinism]") {
    const auto run = [](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        const FloatGridPtr grid = meshToLevelSet(test::sphereMesh(10, 4), 0.3, 3, "sphere", ctx);
        const Mesh mesh = levelSetToMesh(*grid, {}, ctx);
        return std::make_pair(levelSetHash(*grid),
                              mesh.points.size() ? mesh.points[mesh.points.size() / 2].x : 0.f);
    };
    CHECK(run(1) == run(2));
}
