#include "libvdbsynth/pipeline/texture/texture_target.h"

#include <catch2/catch.hpp>

#include <atomic>
#include <cmath>

#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/vdb_file.h"
#include "tests/support/level_sets.h"
#include "tests/support/makers.h"
#include "tests/support/said.h"
#include "tests/support/temporary_folder.h"

using namespace vdbsynth;

TEST_CASE("kindOf: a .ply is points, other meshes are meshes, the rest level sets", "[pipeline]") {
    const test::TemporaryFolder folder;
    writeMesh(folder.path("a.ply"), MeshFormat::Ply, test::boxMesh({0, 0, 0}, {1, 1, 1}));
    CHECK(kindOf(folder.path("a.ply")) == TargetKind::Points);
    CHECK(kindOf("a.off") == TargetKind::Mesh);
    CHECK(kindOf("a.xyz") == TargetKind::Points);
    CHECK(kindOf("a.vdb") == TargetKind::LevelSet);
    CHECK(kindOf("a.nii") == TargetKind::LevelSet);
}

TEST_CASE("makeSites: elements at one place are one site with the mean normal", "[pipeline][fast]") {
    TextureShape shape;
    shape.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {-0.f, 0, 0}};
    makeSites(shape, {{0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
    CHECK(shape.siteOf == std::vector<std::uint32_t>{0, 1, 0, 0});
    REQUIRE(shape.site.size() == 2);
    CHECK(shape.normal[0].y == Approx(std::sqrt(0.5)));
    CHECK(shape.normal[0].z == Approx(std::sqrt(0.5)));
    // Two sides of a sheet: the first one's.
    shape.points = {{0, 0, 0}, {0, 0, 0}};
    makeSites(shape, {{0, 0, 1}, {0, 0, -1}});
    CHECK(shape.normal[0].z == 1);
}

TEST_CASE("makeSites: any points get unit normals", "[pipeline]") {
    for (const std::vector<Vec3f>& points : {std::vector<Vec3f>{{0, 0, 0}},
                                             {{0, 0, 0}, {1, 0, 0}},
                                             {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                             std::vector<Vec3f>(9, Vec3f{1, 2, 3}),
                                             {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}}) {
        TextureShape shape;
        shape.points = points;
        makeSites(shape, {});
        REQUIRE(shape.normal.size() == shape.site.size());
        for (const Vec3f& n : shape.normal) CHECK(length(n) == Approx(1));
    }
}

TEST_CASE("loadTarget: a mesh as mesh, as points and as a level set", "[pipeline]") {
    const test::TemporaryFolder folder;
    Mesh mesh = test::sphereMesh(1, 3);
    mesh.points.push_back({9, 9, 9});  // used by no face
    writeMesh(folder.path("a.off"), MeshFormat::Off, mesh);
    test::Said said;
    const TextureShape own = loadTarget(folder.path("a.off"), {}, {}, said.ctx);
    CHECK(own.kind == TargetKind::Mesh);
    CHECK(own.triangles.size() == mesh.triangles.size());
    CHECK(own.site.size() == mesh.points.size() - 1);
    CHECK(said.noted("1 vertices without faces"));
    for (std::size_t i = 0; i < own.site.size(); ++i) REQUIRE(dot(own.normal[i], own.site[i]) > 0.98f);
    const TextureShape points = loadTarget(folder.path("a.off"), TargetKind::Points, {});
    CHECK(points.triangles.empty());
    CHECK(points.site.size() == own.site.size());
    CHECK(dot(points.normal[3], points.site[3]) > 0.98f);
    ModelOptions model;
    model.resolution = 24;
    const TextureShape level = loadTarget(folder.path("a.off"), TargetKind::LevelSet, model);
    CHECK(level.kind == TargetKind::LevelSet);
    REQUIRE(level.model.grid);
    CHECK(level.site.size() > 500);
}

TEST_CASE("loadTarget: a .ply with faces is points unless a mesh is wanted", "[pipeline]") {
    const test::TemporaryFolder folder;
    writeMesh(folder.path("a.ply"), MeshFormat::Ply, test::sphereMesh(1, 2));
    test::Said said;
    const TextureShape points = loadTarget(folder.path("a.ply"), {}, {}, said.ctx);
    CHECK(points.kind == TargetKind::Points);
    CHECK(points.triangles.empty());
    CHECK(said.noted("its faces are left out"));
    CHECK(said.noted("has no normals"));
    CHECK_FALSE(loadTarget(folder.path("a.ply"), TargetKind::Mesh, {}).triangles.empty());
}

TEST_CASE("loadTarget: points are no mesh, a level set gives its zero level", "[pipeline][error]") {
    const test::TemporaryFolder folder;
    folder.write("a.xyz", "0 0 0\n1 0 0\nnan 0 0\n0 1 0\n");
    const test::Thrown thrown =
        test::thrownBy([&] { loadTarget(folder.path("a.xyz"), TargetKind::Mesh, {}); });
    CHECK(thrown.code == int(ErrorCode::Unusable));
    CHECK(test::contains(thrown.message, "`as` levelset"));
    test::Said said;
    CHECK(loadTarget(folder.path("a.xyz"), {}, {}, said.ctx).site.size() == 3);
    CHECK(said.noted("1 points without finite coordinates"));
    const FloatGridPtr ball = test::ball();
    ball->setName("surface");
    writeVdb(folder.path("a.vdb"), {ball}, {});
    const TextureShape level = loadTarget(folder.path("a.vdb"), {}, {});
    CHECK(level.kind == TargetKind::LevelSet);
    for (const Vec3f& p : level.site) REQUIRE(length(p) == Approx(10).margin(0.1));
    CHECK(loadTarget(folder.path("a.vdb"), TargetKind::Mesh, {}).model.grid == nullptr);
    CHECK(test::thrownBy([&] { loadTarget(folder.path("a.doc"), {}, {}); }).code ==
          int(ErrorCode::InvalidOption));
}

TEST_CASE("targetOf: what is in memory gives what its file gives", "[pipeline][property]") {
    const test::TemporaryFolder folder;
    const Mesh mesh = test::sphereMesh(1, 3);
    writeMesh(folder.path("a.ply"), MeshFormat::Ply, mesh);  // binary: the same bits
    const auto same = [](const TextureShape& own, const TextureShape& read) {
        CHECK(own.kind == read.kind);
        CHECK(own.triangles == read.triangles);
        CHECK(own.siteOf == read.siteOf);
        REQUIRE(own.site.size() == read.site.size());
        for (std::size_t i = 0; i < own.site.size(); ++i) {
            REQUIRE(own.site[i].x == read.site[i].x);
            REQUIRE(own.normal[i].z == read.normal[i].z);
        }
    };
    same(targetOf(mesh, "mesh"), loadTarget(folder.path("a.ply"), TargetKind::Mesh, {}));
    PointCloud cloud;
    cloud.points = cloud.normals = mesh.points;
    cloud.attributes = {{"age", 1, std::vector<float>(mesh.points.size(), 2.f)}};
    writePointsPly(folder.path("p.ply"), cloud);
    const TextureShape points = targetOf(cloud, "points");
    same(points, loadTarget(folder.path("p.ply"), {}, {}));
    REQUIRE(points.attributes.size() == 1);
    CHECK(points.attributes[0].values[0] == 2);
    writeVdb(folder.path("a.vdb"), {test::ball()}, {});
    const LevelSet model = readVdbModel(folder.path("a.vdb"));
    const TextureShape level = targetOf(model, "model");
    same(level, loadTarget(folder.path("a.vdb"), {}, {}));
    CHECK(level.model.grid == model.grid);
    // What is missing is said under the name that was given.
    cloud.normals.clear();
    test::Said said;
    targetOf(cloud, "the scan", said.ctx);
    CHECK(said.noted("the scan: has no normals"));
    test::Thrown thrown = test::thrownBy([&] {
        std::atomic<bool> stop{true};
        RunContext context;
        context.cancel = &stop;
        targetOf(model, "model", context);
    });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
