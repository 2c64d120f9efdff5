#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "tests/support/level_sets.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;
using test::ball;

namespace {

bool sameMesh(const Mesh& a, const Mesh& b) {
    return a.triangles == b.triangles && a.quads == b.quads &&
           std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                      [](const Vec3f& p, const Vec3f& q) { return p.x == q.x && p.y == q.y && p.z == q.z; });
}

}  // namespace

TEST_CASE("levelSetToMesh: closed, manifold, outward, on the zero level", "[vdb][property]") {
    const FloatGridPtr grid = ball();
    std::size_t faces = 0;
    for (double adaptivity : {0.0, 0.3, 1.0}) {
        INFO(adaptivity);
        MeshingOptions options;
        options.adaptivity = adaptivity;
        const Mesh mesh = levelSetToMesh(*grid, options);
        const MeshSummary s = summarize(mesh);
        CHECK(s.closedManifold());
        CHECK(s.signedVolume == Approx(4188.8).epsilon(adaptivity > 0 ? 0.2 : 0.02));
        if (adaptivity > 0) {
            CHECK(mesh.faceCount() < faces);
            continue;
        }
        faces = mesh.faceCount();
        for (const Vec3f& p : mesh.points) REQUIRE(double(length(p)) == Approx(10).margin(0.02));
    }
}

TEST_CASE("levelSetToMesh: in the world, faces outward whether or not the transform reflects",
          "[vdb][property]") {
    const FloatGridPtr grid = ball();
    grid->transform().postRotate(0.7, openvdb::math::Y_AXIS);
    grid->transform().postTranslate(openvdb::Vec3d(3, -4, 5));
    for (const openvdb::Vec3d& scale : {openvdb::Vec3d(2, 2, 2), openvdb::Vec3d(-1, 1, 1)}) {
        const FloatGridPtr other = grid->deepCopy();
        other->transform().postScale(scale);
        const MeshSummary s = summarize(levelSetToMesh(*other));
        CHECK(s.closedManifold());
        CHECK(s.signedVolume == Approx(4188.8 * std::abs(scale.x() * scale.y() * scale.z())).epsilon(0.02));
        CHECK((s.boxMin.x + s.boxMax.x) / 2 == Approx(3 * scale.x()).margin(0.1));
        CHECK((s.boxMin.y + s.boxMax.y) / 2 == Approx(-4 * scale.y()).margin(0.1));
    }
}

TEST_CASE("levelSetToMesh: faces outward, whatever class the grid is marked as", "[vdb][property]") {
    const FloatGridPtr grid = ball();
    for (openvdb::GridClass marked : {openvdb::GRID_LEVEL_SET, openvdb::GRID_UNKNOWN})
        for (bool sharp : {false, true}) {
            grid->setGridClass(marked);
            MeshingOptions options;
            options.sharp = sharp;
            INFO("class " << marked << ", sharp " << sharp);
            CHECK(summarize(levelSetToMesh(*grid, options)).signedVolume == Approx(4188.8).epsilon(0.02));
            CHECK(grid->getGridClass() == marked);
        }
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
        const MeshSummary s = summarize(levelSetToMesh(*scatterBricks(field, {0, 0, 0}, 1.f, 3.f)));
        CHECK(s.openEdges == 0);
        CHECK(s.nonManifoldEdges == 0);
        CHECK(s.misorientedEdges == 0);
    }
}

TEST_CASE("levelSetToMesh: options out of their range, nothing to mesh, cancel", "[vdb][error][cancel]") {
    const auto empty = openvdb::FloatGrid::create(3.f);
    CHECK(test::thrownBy([&] { levelSetToMesh(*empty); }).code == int(ErrorCode::EmptyInput));
    const auto refusal = [&](double adaptivity, bool sharp) {
        MeshingOptions options;
        options.adaptivity = adaptivity;
        options.sharp = sharp;
        const test::Thrown thrown = test::thrownBy([&] { levelSetToMesh(*empty, options); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::thrownBy([&] { validate(options); }).message == thrown.message);
        return thrown.message;
    };
    for (double adaptivity : {-0.01, 1.01, std::nan("")})
        CHECK(test::contains(refusal(adaptivity, false), "`adaptivity`"));
    CHECK(test::contains(refusal(0.5, true), "`sharp` and `adaptivity`"));
    std::atomic<bool> cancel{true};
    RunContext ctx;
    ctx.cancel = &cancel;
    for (bool sharp : {false, true}) {
        MeshingOptions options;
        options.sharp = sharp;
        CHECK(test::thrownBy([&] { levelSetToMesh(*ball(), options, ctx); }).code ==
              int(ErrorCode::Cancelled));
    }
}

TEST_CASE("levelSetToMesh: same bits for any number of threads", "[vdb][determinism]") {
    const FloatGridPtr grid = ball();
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    for (double adaptivity : {0.0, 0.5}) {
        MeshingOptions options;
        options.adaptivity = adaptivity;
        CHECK(sameMesh(levelSetToMesh(*grid, options, one), levelSetToMesh(*grid, options, four)));
    }
}
