#include "libvdbsynth/distance/point_field.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

using namespace vdbsynth;

namespace {

const Vec3f kCentre{20.3f, -4.1f, 7.6f};
constexpr double kRadius = 13;

PointCloud ball() {
    PointCloud cloud;
    for (const Vec3f& p : test::sphereMesh(1, 4).points) {
        cloud.points.push_back(kCentre + p * float(kRadius));
        cloud.normals.push_back(p);
    }
    return cloud;
}

// A square sheet in the plane z = 10.4.
PointCloud sheet() {
    PointCloud cloud;
    for (int x = 0; x <= 30; ++x)
        for (int y = 0; y <= 30; ++y) {
            cloud.points.push_back({float(x), float(y), 10.4f});
            cloud.normals.push_back({0, 0, 1});
        }
    return cloud;
}

double ballDistance(const Index3& p) {
    return length(Vec3d{double(p.x), double(p.y), double(p.z)} - cast<double>(kCentre)) - kRadius;
}

}  // namespace

TEST_CASE("pointField: of points on a ball, its level is the ball's", "[distance][oracle]") {
    const PointSolid solid = pointField(ball());
    CHECK(solid.solidShare > 0.99);
    std::size_t near = 0, wrong = 0;
    double farthest = 0;
    forEachVoxel(solid.field.box(), [&](const Index3& p) {
        const double d = ballDistance(p), value = double(solid.field.at(p));
        wrong += std::abs(value) > 3 ? 1 : 0;
        if (std::abs(d) > 0.2) wrong += (value < 0) == (d < 0) ? 0 : 1;
        if (std::abs(d) > 1) return;
        farthest = std::max(farthest, std::abs(value - d));
        ++near;
    });
    CHECK(near > 3000);
    CHECK(wrong == 0);
    CHECK(farthest < 0.15);
    // All that is within the limit of the points is in the field.
    CHECK(solid.field.box().contains(IndexBox{{4, -20, -8}, {36, 12, 23}}));
}

TEST_CASE("pointField: few points on a ball give it to a hundredth of their spacing", "[distance][oracle]") {
    // 3.3 voxels apart. Their tangent planes alone would give a ball that is 0.2 voxels too large.
    const test::PointShape sphere = test::spiralSphere(200, kRadius);
    PointCloud few;
    few.normals = sphere.normal;
    for (const Vec3f& p : sphere.point) few.points.push_back(kCentre + p);
    const BrickField field = pointField(few).field;
    double largest = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        const double d = ballDistance(p);
        if (std::abs(d) < 1) largest = std::max(largest, std::abs(double(field.at(p)) - d));
    });
    CHECK(largest < 0.03);
}

TEST_CASE("pointField: a sheet has no inside, and as a shell its thickness", "[distance][oracle]") {
    CHECK(pointField(sheet()).solidShare < 0.1);
    PointFieldOptions options;
    options.thickness = 4;
    options.limit = 2.5f;
    const PointSolid shell = pointField(sheet(), options);
    CHECK(shell.solidShare == 1);
    for (int z = 4; z <= 17; ++z) {
        const double expected = std::clamp(std::abs(z - 10.4) - 2, -2.5, 2.5);
        CAPTURE(z);
        CHECK(double(shell.field.at({15, 14, z})) == Approx(expected).margin(z > 7 && z < 14 ? 1e-4 : 0.25));
    }
    // It ends about a spacing beyond its last points.
    CHECK(shell.field.at({15, 30, 10}) < 0);
    CHECK(shell.field.at({15, 36, 10}) > 0);
    CHECK(shell.field.at({-6, 15, 10}) > 0);
}

TEST_CASE("pointField: a gap between points is closed", "[distance][property]") {
    PointCloud open;
    const PointCloud whole = ball();
    for (std::size_t i = 0; i < whole.points.size(); ++i)
        if (whole.normals[i].z < 0.9f) {  // a hole of 11 voxels across
            open.points.push_back(whole.points[i]);
            open.normals.push_back(whole.normals[i]);
        }
    REQUIRE(open.points.size() < whole.points.size() - 30);
    const BrickField field = pointField(open).field;
    const int x = 20, y = -4;
    for (int z = 0; z <= 17; ++z) CHECK(field.at({x, y, z}) < 0);
    for (int z = 22; z <= field.box().max.z; ++z) CHECK(field.at({x, y, z}) > 0);
}

TEST_CASE("pointField: eight points at the corners of a cube are enough", "[distance][degenerate]") {
    PointCloud cube;
    for (int i = 0; i < 8; ++i) {
        const Vec3f n = normalized(Vec3f{i & 4 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 1 ? 1.f : -1.f});
        cube.normals.push_back(n);
        cube.points.push_back(n * 4.f);
    }
    const BrickField field = pointField(cube).field;
    CHECK(field.finite());
    CHECK(field.at({0, 0, 0}) < 0);
    CHECK(field.at({7, 7, 7}) > 0);
    CHECK(field.at({-9, 0, 0}) > 0);
}

TEST_CASE("pointField: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const PointCloud cloud = ball();
    const auto made = [&](const RunContext& ctx) { return pointField(cloud, {}, ctx); };
    const PointSolid one = made(test::onThreads(1)), four = made(test::onThreads(4));
    CHECK(test::samplesOf(one.field) == test::samplesOf(four.field));
    CHECK(one.solidShare == four.solidShare);
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}
