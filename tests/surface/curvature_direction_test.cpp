#include "libvdbsynth/surface/curvature_direction.h"

#include "libvdbsynth/surface/surface_shell.h"

#include <catch2/catch.hpp>

#include "tests/support/shapes.h"

#include <atomic>

using namespace vdbsynth;

namespace {

std::size_t clearIn(const std::vector<Vec3f>& directions) {
    return std::size_t(
        std::count_if(directions.begin(), directions.end(), [](const Vec3f& d) { return length(d) > 0; }));
}

// True where the border of the box, at which gradients are one-sided, is far.
bool isInner(const Vec3f& p, int side) {
    return std::min({p.x, p.y, p.z}) > 6 && std::max({p.x, p.y, p.z}) < float(side - 7);
}

// A ring of radius 14 and thickness 6 round the z axis through the middle.
std::shared_ptr<const BrickField> torusField() {
    return test::shapeField({48, 48, 24}, [](const Vec3d& p) {
        return std::hypot(std::hypot(p.x - 23.5, p.y - 23.5) - 14, p.z - 11.5) - 6;
    });
}

}  // namespace

TEST_CASE("curvatureDirections: along a cylinder, with one sign, and none on a plane", "[surface][oracle]") {
    const SurfaceShell cylinder = surfaceShell(*test::cylinderField(40, 12));
    const std::vector<Vec3f> along = curvatureDirections(cylinder);
    std::size_t clear = 0;
    int up = 0;
    for (const Vec3f& d : along) {
        if (length(d) == 0) continue;
        ++clear;
        CHECK(std::abs(d.z) > 0.97f);
        up += d.z > 0;
    }
    CHECK(clear > cylinder.size() * 9 / 10);
    CHECK((up == 0 || std::size_t(up) == clear));
    CHECK(clearIn(curvatureDirections(surfaceShell(*test::planeField(32, 15.4)))) == 0);
}

TEST_CASE("curvatureDirections: along a cylinder that is tilted in all axes", "[surface][oracle]") {
    const Vec3d axis = normalized(Vec3d{1, 2, 2});
    const SurfaceShell shell = surfaceShell(*test::shapeField({40, 40, 40}, [&](const Vec3d& p) {
        return length(cross(p - Vec3d{19.5, 19.5, 19.5}, axis)) - 9;
    }));
    const std::vector<Vec3f> along = curvatureDirections(shell);
    std::size_t inner = 0;
    float sign = 0;
    for (std::size_t i = 0; i < shell.size(); ++i) {
        if (!isInner(shell.point[i], 40)) continue;
        ++inner;
        const float cosine = dot(along[i], cast<float>(axis));
        if (sign == 0) sign = cosine < 0 ? -1.f : 1.f;
        REQUIRE(cosine * sign > 0.97f);
    }
    CHECK(inner > 500);
}

TEST_CASE("curvatureDirections: round a ring, where the two curvatures differ in sign too",
          "[surface][oracle]") {
    // Across the ring curvature is 1 / 6, along it at most 1 / 8 in either sign.
    const SurfaceShell shell = surfaceShell(*torusField());
    const std::vector<Vec3f> directions = curvatureDirections(shell);
    int forward = 0, backward = 0;
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const Vec3f out = shell.point[i] - Vec3f{23.5f, 23.5f, 11.5f};
        const float cosine = dot(directions[i], normalized(Vec3f{-out.y, out.x, 0}));
        REQUIRE(std::abs(cosine) > 0.9f);
        REQUIRE(std::abs(dot(directions[i], shell.normal[i])) < 1e-3f);
        REQUIRE(length(directions[i]) == Approx(1).margin(1e-4));
        (cosine > 0 ? forward : backward) += 1;
    }
    CHECK(std::min(forward, backward) == 0);
}

TEST_CASE("curvatureDirections: strong directions spread into weak regions", "[surface][property]") {
    // A capsule along z: its caps are parts of a ball; next to the cylinder they take its direction.
    const SurfaceShell shell = surfaceShell(*test::shapeField({32, 32, 48}, [](const Vec3d& p) {
        return length(p - Vec3d{15.5, 15.5, std::clamp(p.z, 14.5, 32.5)}) - 9;
    }));
    const std::vector<Vec3f> directions = curvatureDirections(shell);
    std::size_t caps = 0, spread = 0;
    for (std::size_t i = 0; i < shell.size(); ++i) {
        const float beyond = std::abs(shell.point[i].z - 23.5f) - 9;
        if (beyond < 0) {
            REQUIRE(std::abs(directions[i].z) > 0.97f);
        } else if (beyond > 1 && beyond < 3) {
            ++caps;
            spread += std::abs(directions[i].z) > 0.8f;
        }
    }
    REQUIRE(caps > 100);
    CHECK(spread == caps);
}

TEST_CASE("curvatureDirections: the same bits for any threads, stops when asked to",
          "[surface][determinism][cancel]") {
    const SurfaceShell shell = surfaceShell(*torusField());
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    const std::vector<Vec3f> a = curvatureDirections(shell, one), b = curvatureDirections(shell, four);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        REQUIRE((a[i].x == b[i].x && a[i].y == b[i].y && a[i].z == b[i].z));
    std::atomic<bool> stop{true};
    stopped.cancel = &stop;
    CHECK(test::thrownBy([&] { curvatureDirections(shell, stopped); }).code == int(ErrorCode::Cancelled));
}
