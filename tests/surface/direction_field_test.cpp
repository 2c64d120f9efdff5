#include "libvdbsynth/surface/direction_field.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

using namespace vdbsynth;

namespace {

std::vector<Vec3f> alongAll(const SurfaceShell& shell, const Vec3f& direction) {
    return std::vector<Vec3f>(shell.size(), direction);
}

}  // namespace

TEST_CASE("directionField: one stroke on a plane gives that direction everywhere", "[surface]") {
    const SurfaceShell shell = surfaceShell(*test::planeField(48, 20.3));
    std::vector<Vec3f> given(shell.size());
    given[shell.size() / 3] = {3, 4, 7};  // its part along the normal does not count
    const DirectionField field = directionField(shell, given);
    CHECK(field.known == 1);
    CHECK(field.singularities.empty());
    for (const Vec3f& t : field.tangent) {
        CHECK(t.x == Approx(0.6).margin(1e-3));
        CHECK(t.y == Approx(0.8).margin(1e-3));
    }
}

TEST_CASE("directionField: an axis over a sphere is singular at its poles and nowhere else", "[surface]") {
    const SurfaceShell shell = surfaceShell(*test::sphereField(48, 17));
    const DirectionField field = directionField(shell, alongAll(shell, {0, 0, 1}));
    REQUIRE(field.singularities.size() == 2);
    for (const Vec3f& p : field.singularities) CHECK(std::abs(p.z - 23.5f) > 15);
    for (std::size_t i = 0; i < shell.size(); ++i) {
        CHECK(length(field.tangent[i]) == Approx(1).margin(1e-4));
        CHECK(std::abs(dot(field.tangent[i], shell.normal[i])) < 1e-4f);
        if (std::abs(shell.normal[i].z) < 0.8f) CHECK(field.tangent[i].z > 0.5f);
    }
}

TEST_CASE("directionField: what lies along the normal everywhere is an error", "[surface]") {
    const SurfaceShell shell = surfaceShell(*test::planeField(24, 11.5));
    for (const Vec3f& direction : {Vec3f{0, 0, 1}, Vec3f{0, 0, 0}}) {
        const test::Thrown thrown =
            test::thrownBy([&] { directionField(shell, alongAll(shell, direction)); });
        CHECK(thrown.code == int(ErrorCode::Unusable));
        CHECK(test::contains(thrown.message, "`direction`"));
    }
}

TEST_CASE("directionField: the same for any threads, stops when asked to", "[surface][tsan]") {
    const SurfaceShell shell = surfaceShell(*test::sphereField(40, 14));
    std::vector<Vec3f> given(shell.size());
    given[10] = {1, 0.5f, 0};
    given[shell.size() - 10] = {0, 1, 0.25f};
    RunContext one, five;
    one.threads = 1;
    five.threads = 5;
    const DirectionField a = directionField(shell, given, one), b = directionField(shell, given, five);
    for (std::size_t i = 0; i < shell.size(); ++i) CHECK(length(a.tangent[i] - b.tangent[i]) == 0);
    std::atomic<bool> stop{true};
    RunContext stopped;
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { directionField(shell, given, stopped); }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("directionField: a part of the surface that an axis meets steeply still follows it", "[surface]") {
    // A plane that falls away so that the axis lies 30 degrees off its normal.
    const SurfaceShell shell = surfaceShell(*test::shapeField(
        {40, 40, 40}, [](const Vec3d& p) { return 0.5 * (p.x - 20) + 0.866025403784 * (p.z - 20); }));
    const DirectionField field = directionField(shell, alongAll(shell, {0, 0, 1}));
    CHECK(field.singularities.empty());
    for (std::size_t i = 0; i < shell.size(); ++i) {
        // At the border of the box gradients are one-sided.
        const Vec3f& p = shell.point[i];
        if (std::min({p.x, p.y, p.z}) > 2 && std::max({p.x, p.y, p.z}) < 37)
            CHECK(std::abs(field.tangent[i].z) == Approx(0.5).margin(0.05));
    }
}

TEST_CASE("directionField: bumps on a ball add no singularities", "[surface]") {
    const SurfaceShell shell = surfaceShell(*test::shapeField({64, 64, 64}, [](const Vec3d& p) {
        const Vec3d d = p - Vec3d{31.5, 31.5, 31.5};
        return length(d) - 24 - 1.5 * std::cos(d.x / 2.5) * std::cos(d.y / 2.5);
    }));
    CHECK(directionField(shell, alongAll(shell, {0, 0, 1})).singularities.size() <= 4);
}
