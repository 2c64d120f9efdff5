#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

namespace {

// Signed distance to the box from -half to half.
double toBox(const openvdb::Vec3d& p, const Vec3d& half) {
    Vec3d outside;
    double deepest = -1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::abs(p[axis]) - half[axis];
        outside[axis] = std::max(d, 0.0);
        deepest = std::max(deepest, d);
    }
    return length(outside) + std::min(deepest, 0.0);
}

}  // namespace

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
    CHECK(test::thrownBy([] { meshToLevelSet({}, 1, 3, "s"); }).code == int(ErrorCode::EmptyInput));
    RunContext ctx;
    ctx.maxMemory = 1000000000;
    CHECK(test::thrownBy([&] { meshToLevelSet(sphere, 1e-4, 3, "s", ctx); }).code == int(ErrorCode::Memory));
    std::atomic<bool> cancel{true};
    ctx.cancel = &cancel;
    CHECK(test::thrownBy([&] { meshToLevelSet(sphere, 1, 3, "s", ctx); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("meshToLevelSet: same bits for any number of threads", "[vdb][determinism]") {
    const auto hash = [](int threads) {
        RunContext ctx;
        ctx.threads = threads;
        return levelSetHash(*meshToLevelSet(test::sphereMesh(10, 4), 0.3, 3, "sphere", ctx));
    };
    CHECK(hash(1) == hash(4));
}

TEST_CASE("meshToSolid: a closed mesh is that of meshToLevelSet, exact distances if asked for",
          "[vdb][oracle]") {
    openvdb::initialize();
    const Vec3d corner{5.1, 4.3, 3.7};
    const Mesh box = test::boxMesh(cast<float>(corner) * -1.f, cast<float>(corner));
    CHECK(levelSetHash(*meshToSolid(box, 0.5, 3, "box")) ==
          levelSetHash(*meshToLevelSet(box, 0.5, 3, "box")));
    SolidOptions options;
    options.exact = true;
    const FloatGridPtr grid = meshToSolid(box, 0.5, 3, "box", options);
    // OpenVDB's band expansion looks at neighbours' faces only, so a few outer voxels are off.
    std::size_t all = 0, off = 0;
    for (auto it = grid->cbeginValueOn(); it; ++it, ++all) {
        const double exact = toBox(grid->indexToWorld(it.getCoord()), corner);
        off += std::abs(double(*it) - exact) > 1e-5;
        if (std::abs(exact) < 1) REQUIRE(double(*it) == Approx(exact).margin(1e-5));
    }
    CHECK(all > 10000);
    CHECK(off < all / 1000);
}

TEST_CASE("meshToSolid: a shell around a closed mesh is hollow, and needs a thickness",
          "[vdb][oracle][error]") {
    openvdb::initialize();
    SolidOptions shell;
    shell.open = OpenMesh::Shell;
    for (double thickness : {0.0, -1.0, 1e30}) {
        shell.thickness = thickness;
        const test::Thrown thrown = test::thrownBy([&] { validate(shell); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`thickness`"));
    }
    shell.thickness = 2;
    const FloatGridPtr grid = meshToSolid(test::sphereMesh(10, 4), 0.5, 3, "s", shell);
    CHECK(solidVoxels(*grid) * 0.125 == Approx(4.18879 * (1331 - 729)).epsilon(0.02));
    CHECK(grid->tree().getValue(openvdb::Coord(0, 0, 0)) > 0);
    shell.open = OpenMesh::Close;
    shell.thickness = 0;
    CHECK_NOTHROW(validate(shell));
}
