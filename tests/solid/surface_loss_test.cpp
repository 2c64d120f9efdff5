#include "libvdbsynth/solid/surface_loss.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/contexts.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

double boxDistance(const Index3& p, const Vec3d& low, const Vec3d& high) {
    double outside = 0, inside = -1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double beyond = std::max(low[axis] - p[axis], p[axis] - high[axis]);
        outside += std::max(beyond, 0.0) * std::max(beyond, 0.0);
        inside = std::max(inside, beyond);
    }
    return outside > 0 ? std::sqrt(outside) : inside;
}

BrickField boxField(const Vec3d& low, const Vec3d& high, const Index3& size) {
    return test::fieldFrom(
        size, [=](const Index3& p) { return float(std::clamp(boxDistance(p, low, high), -3.0, 3.0)); });
}

Mesh joined(Mesh mesh, const Mesh& other) {
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (const Quad& q : other.quads)
        mesh.quads.push_back({q[0] + first, q[1] + first, q[2] + first, q[3] + first});
    return mesh;
}

}  // namespace

TEST_CASE("surfaceLoss: nothing is lost of what is there", "[solid][hand]") {
    const Mesh mesh = test::boxMesh({8.3f, 8.2f, 8.4f}, {20.6f, 21.5f, 19.7f});
    const SurfaceLoss loss = surfaceLoss(mesh, boxField({8.3, 8.2, 8.4}, {20.6, 21.5, 19.7}, {32, 32, 32}));
    CHECK(loss.share == 0);
    CHECK(loss.volumeLeft == 1);
    CHECK(loss.lostSolids == 0);
}

TEST_CASE("surfaceLoss: one of two boxes is missing", "[solid][hand]") {
    // Areas 600 and 150, so a fifth is lost.
    const Mesh both =
        joined(test::boxMesh({4, 4, 4}, {14, 14, 14}), test::boxMesh({30, 30, 30}, {35, 35, 35}));
    const SurfaceLoss loss = surfaceLoss(both, boxField({4, 4, 4}, {14, 14, 14}, {40, 40, 40}));
    CHECK(loss.share == Approx(0.2));
    CHECK(loss.outerArea == Approx(750));
    CHECK(loss.lostSolids == 1);
    CHECK(loss.solids == 2);
    CHECK(loss.boxMin.x == Approx(30).margin(0.5));
    CHECK(loss.boxMax.z == Approx(35).margin(0.5));
    const std::string text = lossText(loss, 0.5, 15.5);
    CHECK(test::contains(text, "20 % of its surface"));
    CHECK(test::contains(text, "1 of 2 closed parts"));
}

TEST_CASE("surfaceLoss: a void that was filled is lost", "[solid][hand]") {
    Mesh inner = test::boxMesh({12, 12, 12}, {20, 20, 20});
    for (Quad& q : inner.quads) std::swap(q[1], q[3]);
    const Mesh hollow = joined(test::boxMesh({4, 4, 4}, {28, 28, 28}), inner);
    const SurfaceLoss loss = surfaceLoss(hollow, boxField({4, 4, 4}, {28, 28, 28}, {32, 32, 32}));
    CHECK(loss.share == Approx(0.1));
    CHECK(loss.lostCavities == 1);
    CHECK(loss.cavities == 1);
    CHECK(test::contains(lossText(loss, 1, 24), "1 of 1 void"));
}

TEST_CASE("surfaceLoss: faces inside the solid do not count", "[solid][hand]") {
    const Mesh united =
        joined(test::boxMesh({4, 4, 4}, {28, 28, 28}), test::boxMesh({12, 12, 12}, {20, 20, 20}));
    CHECK(surfaceLoss(united, boxField({4, 4, 4}, {28, 28, 28}, {32, 32, 32})).share == 0);
}

TEST_CASE("surfaceLoss: the voxel that keeps a plate is found", "[solid][hand]") {
    // A plate of 0.3 between two lattice planes: no voxel is in it.
    const Mesh plate = test::boxMesh({4, 4, 10.3f}, {28, 28, 10.6f});
    const SurfaceLoss loss = surfaceLoss(plate, BrickField({{0, 0, 0}, {31, 31, 31}}, 3.f));
    CHECK(loss.share == Approx(1));
    CHECK(loss.keepingVoxel > 0.1);
    CHECK(loss.keepingVoxel <= 0.3);
    CHECK(test::contains(lossText(loss, 1, 24), "thinner than a voxel"));
    CHECK(test::contains(lossText(loss, 1, 24), "`resolution`"));
    // A sheet has no thickness: only a shell keeps it.
    Mesh sheet;
    sheet.points = {{4, 4, 10.5f}, {28, 4, 10.5f}, {4, 28, 10.5f}};
    sheet.triangles = {{0, 1, 2}};
    const SurfaceLoss all = surfaceLoss(sheet, BrickField({{0, 0, 0}, {31, 31, 31}}, 3.f));
    CHECK(all.share == Approx(1));
    CHECK(all.lostOpen == 1);
    CHECK(all.keepingVoxel == 0);
    CHECK_FALSE(test::contains(lossText(all, 1, 24), "`resolution`"));
}

TEST_CASE("enclosedVolume: a box and a ball", "[solid][oracle]") {
    CHECK(enclosedVolume(boxField({8.25, 8.25, 8.25}, {20.75, 20.75, 20.75}, {32, 32, 32})) ==
          Approx(12.5 * 12.5 * 12.5).epsilon(0.02));
    const BrickField ball = test::fieldFrom({48, 48, 48}, [](const Index3& p) {
        const double d = length(Vec3d{p.x - 23.3, p.y - 24.1, p.z - 23.8}) - 15;
        return float(std::clamp(d, -3.0, 3.0));
    });
    CHECK(enclosedVolume(ball) == Approx(4.0 / 3 * 3.14159265 * 15 * 15 * 15).epsilon(0.01));
    CHECK(enclosedVolume(BrickField({{0, 0, 0}, {15, 15, 15}}, 3.f)) == 0);
}

TEST_CASE("pointLoss: points off the surface, and their reach", "[solid][hand]") {
    const BrickField field = boxField({8, 8, 8}, {20, 20, 20}, {32, 32, 32});
    const std::vector<Vec3f> points{{8, 12, 12}, {8.4f, 12, 12}, {14, 14, 14}, {10, 12, 12}};
    CHECK(pointLoss(points, {0, 0, 0, 0}, field) == 0.5);
    CHECK(pointLoss(points, {0, 0, 0, 2.1f}, field) == 0.25);
    CHECK(pointLoss({}, {}, field) == 0);
}

TEST_CASE("surfaceLoss: the same for any number of threads, and it can be cancelled", "[solid][threads]") {
    const Mesh both =
        joined(test::boxMesh({4, 4, 4}, {14, 14, 14}), test::boxMesh({30.3f, 30, 30}, {35, 35, 35}));
    const BrickField field = boxField({4, 4, 4}, {14, 14, 14}, {40, 40, 40});
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    CHECK(surfaceLoss(both, field, one).share == surfaceLoss(both, field, four).share);
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { surfaceLoss(both, field, stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("surfaceLoss: a part that vanished beside another is said, though within a voxel of it",
          "[solid][hand]") {
    const Mesh both = joined(test::boxMesh({4, 4, 4}, {14, 14, 14}),
                             test::boxMesh({14.3f, 8.2f, 8.2f}, {14.8f, 8.7f, 8.7f}));
    const SurfaceLoss loss = surfaceLoss(both, boxField({4, 4, 4}, {14, 14, 14}, {24, 24, 24}));
    CHECK(loss.lostSolids == 1);
    CHECK(loss.keepingVoxel > 0);
    CHECK(test::contains(lossText(loss, 1, 11), "1 of 2 closed parts"));
}

TEST_CASE("surfaceLoss: what is united with a void is none", "[solid][hand]") {
    Mesh hollow = test::boxMesh({12, 12, 12}, {20, 20, 20});
    hollow = joined(hollow, test::boxMesh({14, 14, 14}, {18, 18, 18}));
    for (Quad& q : hollow.quads) std::swap(q[1], q[3]);
    hollow = joined(hollow, test::boxMesh({4, 4, 4}, {28, 28, 28}));
    const BrickField field = test::fieldFrom({32, 32, 32}, [](const Index3& p) {
        const double outer = boxDistance(p, {4, 4, 4}, {28, 28, 28}),
                     inner = boxDistance(p, {12, 12, 12}, {20, 20, 20});
        return float(std::clamp(std::max(outer, -inner), -3.0, 3.0));
    });
    CHECK(surfaceLoss(hollow, field).share == 0);
}
