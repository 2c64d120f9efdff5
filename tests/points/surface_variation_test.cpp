#include "libvdbsynth/points/surface_variation.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

TEST_CASE("surfaceVariation: the six corners of an octahedron and points in a plane, by hand") {
    const std::vector<Vec3f> corners{{1, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 3}, {0, 0, -3}};
    // All six are neighbours: variances as 1 : 4 : 9.
    for (float v : surfaceVariation(corners, {}, 5)) CHECK(v == Approx(1.0 / 14));
    const test::PointShape plane = test::latticePlane(12);
    for (float v : surfaceVariation(plane.point)) CHECK(v == Approx(0).margin(1e-7));
}

TEST_CASE("surfaceVariation: of a sphere it falls with the square of its radius") {
    const auto meanOf = [](double radius) {
        const auto count = std::size_t(4 * kPi * radius * radius);
        const std::vector<float> v = surfaceVariation(test::spiralSphere(count, radius).point);
        double sum = 0;
        for (float x : v) sum += double(x);
        return sum / double(v.size());
    };
    CHECK(meanOf(10) / meanOf(20) == Approx(4).epsilon(0.1));
    CHECK(meanOf(20) < 1e-3);
}

TEST_CASE("surfaceVariation: with normals a sheet below does not count") {
    test::PointShape sheets = test::latticePlane(12), under = sheets;
    for (Vec3f& p : under.point) p.z = -1;
    for (Vec3f& n : under.normal) n.z = -1;
    sheets = test::joined(sheets, under);
    for (float v : surfaceVariation(sheets.point, sheets.normal)) CHECK(v == Approx(0).margin(1e-7));
    CHECK(surfaceVariation(sheets.point)[70] > 0.05);
}

TEST_CASE("surfaceVariation: few points, coinciding ones, and what is refused") {
    CHECK(surfaceVariation({}).empty());
    CHECK(surfaceVariation({{1, 2, 3}}) == std::vector<float>{0});
    for (float v : surfaceVariation(std::vector<Vec3f>(30, {1, 2, 3}))) CHECK(v == 0);
    const std::vector<Vec3f> some(10), up(9, {0, 0, 1});
    CHECK(test::thrownBy([&] { surfaceVariation(some, {}, 2); }).message.find("`neighbours` 2") == 0);
    CHECK(test::thrownBy([&] { surfaceVariation(some, up); }).code == int(ErrorCode::ShapeMismatch));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              surfaceVariation(some, {}, 5, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("surfaceVariation: same bits for any number of threads", "[points][tsan]") {
    const test::PointShape plane = test::randomPlane(4000, 60);
    CHECK(surfaceVariation(plane.point, {}, 9, test::onThreads(1)) ==
          surfaceVariation(plane.point, {}, 9, test::onThreads(8)));
}
