#include "libvdbsynth/measure/minimal_wall.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// A narrow band of exact or nearly exact distances.
BrickField solid(const Index3& size, const std::function<double(const Vec3d&)>& distance) {
    return test::fieldFrom(size, [&](const Index3& p) {
        return float(std::clamp(distance({double(p.x), double(p.y), double(p.z)}), -3.0, 3.0));
    });
}

double box(const Vec3d& p, const Vec3d& low, const Vec3d& high) {
    return std::max({low.x - p.x, p.x - high.x, low.y - p.y, p.y - high.y, low.z - p.z, p.z - high.z});
}

double wallOf(const BrickField& field, double share = 0.001) {
    const auto wall = minimalWall(field, {share});
    REQUIRE(wall);
    return wall->thickness;
}

}  // namespace

TEST_CASE("minimalWall: a plate gives its thickness, a ball its diameter, a box its shortest side",
          "[measure][oracle]") {
    for (double thickness : {1.5, 4.0, 7.3}) {
        INFO(thickness);
        CHECK(wallOf(solid({50, 40, 20}, [&](const Vec3d& p) {
                  return box(p, {3, 3, 5.2}, {46, 36, 5.2 + thickness});
              })) == Approx(thickness).margin(0.3));
        // Across the lattice.
        const Vec3d normal = normalized(Vec3d{1, 2, 3});
        CHECK(wallOf(solid({40, 40, 40}, [&](const Vec3d& p) {
                  const double across = std::abs(dot(p - Vec3d{20, 20, 20}, normal)) - thickness / 2;
                  return std::max(across, length(p - Vec3d{20, 20, 20}) - 17);
              })) == Approx(thickness).margin(0.3));
    }
    for (double radius : {5.0, 10.0, 25.0})
        CHECK(wallOf(solid({60, 60, 60}, [&](const Vec3d& p) {
                  return length(p - Vec3d{29.3, 30, 30.4}) - radius;
              })) == Approx(2 * radius).margin(0.3));
    CHECK(wallOf(solid({50, 40, 40}, [](const Vec3d& p) {
              return box(p, {3.3, 3.3, 3.3}, {45.1, 30.9, 33.3});
          })) == Approx(27.6).margin(0.3));
}

TEST_CASE("minimalWall: the tip of a cone is small, and the place is at the tip", "[measure][oracle]") {
    // Its half-angle is 20 degrees, its slope 64 voxels long: of the tip of 2 voxels, a thousandth of the
    // area, the thickness is 2 tan(40) = 1.7.
    const double s = 0.342020143, c = 0.939692621;
    const BrickField cone = solid({50, 50, 70}, [&](const Vec3d& p) {
        const double r = std::sqrt((p.x - 25) * (p.x - 25) + (p.y - 25) * (p.y - 25));
        return std::max(c * r - s * (65 - p.z), 5 - p.z);
    });
    const auto wall = minimalWall(cone);
    REQUIRE(wall);
    CHECK(wall->thickness < 3);
    CHECK(wall->thickness > 0.5);
    CHECK(length(wall->place - Vec3d{25, 25, 65}) < 6);
}

TEST_CASE("minimalWall: the share is of the area", "[measure][oracle]") {
    // A plate 4 thick over one half, 8 over the other, and a pin of 2 that has less than a hundredth.
    const BrickField steps = solid({70, 40, 30}, [](const Vec3d& p) {
        return std::min({box(p, {3, 3, 5.5}, {35, 36, 9.5}), box(p, {34, 3, 5.5}, {66, 36, 13.5}),
                         box(p, {10.4, 10.4, 8}, {12.4, 12.4, 14})});
    });
    CHECK(wallOf(steps, 0.002) == Approx(2).margin(0.3));
    CHECK(wallOf(steps, 0.1) == Approx(4).margin(0.3));
    CHECK(wallOf(steps, 0.6) == Approx(8).margin(0.3));
}

TEST_CASE("minimalWall: a solid that leaves the box has no wall, a slab through it has",
          "[measure][degenerate]") {
    CHECK_FALSE(minimalWall(solid({30, 30, 30}, [](const Vec3d& p) { return p.z - 15.2; })));
    CHECK(wallOf(solid({30, 30, 30}, [](const Vec3d& p) { return std::abs(p.z - 15.2) - 3; })) ==
          Approx(6).margin(0.1));
    // One voxel in the solid.
    CHECK(wallOf(solid({8, 8, 8}, [](const Vec3d& p) { return length(p - Vec3d{4, 4, 4}) - 0.4; })) < 1);
}

TEST_CASE("minimalWall: same bits for any number of threads, cancel", "[measure][determinism]") {
    const BrickField balls = test::ballsField({60, 60, 60}, 3, 3, 12);
    RunContext one;
    one.threads = 1;
    const auto a = minimalWall(balls, {}, one), b = minimalWall(balls);
    REQUIRE((a && b));
    CHECK((a->thickness == b->thickness && length(a->place - b->place) == 0));
    const std::atomic<bool> stop{true};
    RunContext ctx;
    ctx.cancel = &stop;
    CHECK(test::thrownBy([&] { minimalWall(balls, {}, ctx); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("minimalWall: errors", "[measure][error]") {
    const BrickField ball = solid({20, 20, 20}, [](const Vec3d& p) {
        return length(p - Vec3d{10, 10, 10}) - 6;
    });
    for (double share : {0.0, -1.0, 1.1, std::nan("")}) {
        const test::Thrown thrown = test::thrownBy([&] { minimalWall(ball, {share}); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`share`"));
        CHECK(test::thrownBy([&] { validate(MinimalWallOptions{share}); }).message == thrown.message);
    }
    const auto code = [](const BrickField& field) {
        return test::thrownBy([&] { minimalWall(field); }).code;
    };
    CHECK(code({}) == int(ErrorCode::InvalidOption));
    CHECK(code(solid({9, 9, 9}, [](const Vec3d&) { return 2; })) == int(ErrorCode::EmptyInput));
    CHECK(code(test::fieldFrom({9, 9, 9}, [](const Index3&) { return std::nanf(""); })) ==
          int(ErrorCode::BadData));
}
