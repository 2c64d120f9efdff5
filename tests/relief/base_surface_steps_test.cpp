#include "libvdbsynth/relief/base_surface_steps.h"

#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

constexpr double kRadius = 24;
constexpr int kMargin = 20;
constexpr float kReach = 16;

// Signed distance of a voxel to the ball of test::ballField.
double toBall(const Index3& p) {
    const double middle = kRadius + kMargin;
    return length(Vec3d{p.x - middle, p.y - middle, p.z - middle}) - kRadius;
}

const BrickField& ball() {
    static const BrickField field = test::ballField(kRadius, kMargin);
    return field;
}

}  // namespace

TEST_CASE("wideDistances: near and far distances to a ball are those of the formula", "[relief][oracle]") {
    const WideDistances wide = wideDistances(ball(), 3, kReach, {});
    REQUIRE(wide.far.step == kFarStep);
    double sum = 0, count = 0;
    forEachVoxel(wide.near.box(), [&](const Index3& p) {
        const double d = toBall(p);
        const double own = double(wide.near.at(p));
        if (std::abs(d) > double(kNearReach) + 0.1) REQUIRE(std::abs(own) == Approx(kNearReach));
        if (std::abs(d) < double(kNearReach) - 0.1) REQUIRE(own == Approx(d).margin(0.15));
        if (std::abs(d) > 0.1) REQUIRE((own < 0) == (d < 0));
    });
    forEachVoxel(wide.far.field.box(), [&](const Index3& p) {
        const double d = toBall(p * kFarStep);
        const double own = double(wide.far.field.at(p));
        if (std::abs(d) > double(kReach) + 0.2) REQUIRE(std::abs(own) == Approx(kReach));
        // About the middle every place of the ball is as near.
        if (std::abs(d) > double(kReach) - 0.3) return;
        REQUIRE(own == Approx(d).margin(0.35));
        sum += std::abs(own - d);
        ++count;
    });
    CHECK(sum / count < 0.06);  // single samples are up to a sixth of a sample off
}

TEST_CASE("joined: near and far distances meet without a step, clamped to the reach", "[relief][property]") {
    const BrickField both = joined(wideDistances(ball(), 3, kReach, {}), 10, {});
    forEachVoxel(both.box(), [&](const Index3& p) {
        const double d = std::clamp(toBall(p), -10.0, 10.0);
        REQUIRE(double(both.at(p)) == Approx(d).margin(0.35));
    });
}

TEST_CASE("wideDistances: same bits for any number of threads, and cancels", "[relief][determinism]") {
    const WideDistances one = wideDistances(ball(), 3, kReach, test::onThreads(1)),
                        many = wideDistances(ball(), 3, kReach, test::onThreads(8));
    CHECK(test::samplesOf(one.near) == test::samplesOf(many.near));
    CHECK(test::samplesOf(one.far.field) == test::samplesOf(many.far.field));
    CHECK(test::thrownWhenCancelled([](const RunContext& ctx) {
              wideDistances(ball(), 3, kReach, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("wideDistances: a box without a surface is as far as the reach", "[relief][degenerate]") {
    const WideDistances wide = wideDistances(BrickField(IndexBox::fromSize({24, 24, 24}), 3.f), 3, 12, {});
    CHECK(wide.near.at({5, 6, 7}) == kNearReach);
    CHECK(wide.far.field.at({5, 6, 7}) == 12);
}

TEST_CASE("coarserMeans: every second sample, as means over twice the step", "[relief][oracle]") {
    // A wave of 48 voxels on every fourth: means over 2 voxels' deviation, wanted over 4.
    constexpr double kWave = 48;
    const auto at = [](double x) { return sine(2 * kPi * x / kWave); };
    const SmoothField means{
        test::fieldFrom({96, 16, 16}, [&](const Index3& p) { return float(at(4.0 * p.x)); }), 4};
    const SmoothField coarser = coarserMeans(means, {});
    REQUIRE(coarser.step == 8);
    CHECK(coarser.field.box().size().x == 49);
    const double k = 2 * kPi / kWave, left = exponential(-k * k * (16 - 4) / 2);
    for (int x = 6; x < 42; ++x)
        CHECK(double(coarser.field.at({x, 4, 4})) == Approx(left * at(8.0 * x)).margin(0.01));
}

TEST_CASE("coarserMeans: a plane keeps its distances", "[relief][property]") {
    const SmoothField means{
        test::fieldFrom({32, 32, 32}, [](const Index3& p) { return float(4 * p.z - 50); }), 4};
    const SmoothField coarser = coarserMeans(means, {});
    for (int z = 3; z < 13; ++z) CHECK(coarser.field.at({8, 8, z}) == Approx(8 * z - 50).margin(1e-3));
}
