#include "libvdbsynth/surface/frame_field.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/shapes.h"

using namespace vdbsynth;

namespace {

FrameField framesOver(std::shared_ptr<const BrickField> field,
                      const std::function<Vec3f(const Vec3f&)>& direction, const RunContext& ctx = {}) {
    SurfaceShell shell = surfaceShell(*field, ctx);
    std::vector<Vec3f> given;
    for (const Vec3f& p : shell.point) given.push_back(direction(p));
    DirectionField directions = directionField(shell, given, ctx);
    SweepDistance sweep = sweepDistance(shell, directions.tangent, ctx);
    return FrameField(std::move(field), std::move(shell), std::move(directions), std::move(sweep));
}

Vec3f around(const Vec3f& p) {
    return {-(p.y - 19.5f), p.x - 19.5f, 0};
}

}  // namespace

TEST_CASE("FrameField: orthonormal and right-handed in the whole band, normal along the gradient",
          "[surface][property]") {
    const FrameField frames = framesOver(test::sphereField(40, 12), around);
    std::size_t found = 0;
    for (int i = 0; i < 4000; ++i) {
        Random random(2, std::uint64_t(i));
        const Vec3f p{float(random.uniform(6, 33)), float(random.uniform(6, 33)),
                      float(random.uniform(6, 33))};
        const Vec3f out = p - Vec3f{19.5f, 19.5f, 19.5f};
        if (std::abs(length(out) - 12) > 6) continue;
        Frame f;
        float sweep;
        REQUIRE(frames.at(p, f, sweep));
        ++found;
        for (const Vec3f& v : {f.t, f.n, f.b}) CHECK(length(v) == Approx(1).margin(1e-4));
        CHECK(std::abs(dot(f.t, f.n)) < 1e-4f);
        CHECK(length(cross(f.t, f.n) - f.b) < 1e-4f);
        CHECK(dot(f.n, normalized(out)) > 0.98f);
        if (std::abs(out.z) < 8) CHECK(dot(f.t, normalized(around(p))) > 0.95f);
    }
    CHECK(found > 1000);
    Frame f;
    float sweep;
    CHECK_FALSE(frames.at({-30, -30, -30}, f, sweep));
}

TEST_CASE("rotationBetween: turns one frame into the other, half turns too", "[surface]") {
    const Frame a = frameFrom({0, 0, 1}, {1, 0, 0});
    const Vec3f none = rotationBetween(a, a);
    CHECK(length(none) == 0);
    const Frame quarter = frameFrom({0, 0, 1}, {0, 1, 0});
    const Vec3f turn = rotationBetween(a, quarter);
    CHECK(turn.z == Approx(kPi / 2));
    CHECK(std::abs(turn.x) + std::abs(turn.y) < 1e-5f);
    const Frame half = frameFrom({0, 0, 1}, {-1, 0, 0});
    CHECK(std::abs(rotationBetween(a, half).z) == Approx(kPi));
    const Frame over = frameFrom({0, 0, -1}, {1, 0, 0});
    CHECK(std::abs(rotationBetween(a, over).x) == Approx(kPi));
}

TEST_CASE("FrameField: the same bits for any threads", "[surface][tsan]") {
    RunContext one, four;
    one.threads = 1;
    four.threads = 4;
    const auto field = test::cylinderField(40, 12);
    const FrameField a = framesOver(field, around, one), b = framesOver(field, around, four);
    CHECK(a.sweep().distance == b.sweep().distance);
}
