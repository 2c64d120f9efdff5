#include "libvdbsynth/relief/base_scale.h"

#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// A wave on a bigger one: a relief on a shape.
BrickField twoWaves(double wave, double shape) {
    return test::groundField({320, 8, 160}, [=](double x, double) {
        return wave / 16 * sine(2 * kPi * x / wave) + shape / 16 * sine(2 * kPi * x / shape);
    });
}

}  // namespace

TEST_CASE("findBaseRadius: takes the relief and leaves the shape", "[relief][oracle]") {
    const double wave = GENERATE(12.0, 20.0);
    const BaseScale scale = findBaseRadius(twoWaves(wave, 320), 320);
    CAPTURE(wave, scale.radius, scale.reason);
    CHECK(scale.gap);
    // Cut-off wavelengths from just over that of the relief to just under that of the shape.
    CHECK(kCutOff * scale.radius > wave);
    CHECK(kCutOff * scale.radius < 200);
    CHECK_FALSE(scale.reason.empty());
    CHECK(scale.radii.size() == scale.deviation.size());
}

TEST_CASE("findBaseRadius: a plain ball has no gap", "[relief][fast]") {
    const BaseScale scale = findBaseRadius(test::ballField(30, baseMargin(6)), 60);
    CHECK_FALSE(scale.gap);
    CHECK(scale.radius == Approx(1.5));
    CHECK(test::contains(scale.reason, "40th"));
}

TEST_CASE("findBaseRadius: a tiny model still gets a radius that is allowed", "[relief][fast]") {
    const BaseScale scale = findBaseRadius(test::ballField(4, 8), 8);
    CHECK(scale.radius >= 1);
    CHECK(scale.radii.empty());
}

TEST_CASE("findBaseRadius: refuses nothing and no length", "[relief][error]") {
    CHECK(test::thrownBy([&] {
              findBaseRadius(BrickField(IndexBox::fromSize({9, 9, 9}), 3.f), 9);
          }).code == int(ErrorCode::EmptyInput));
    CHECK(test::contains(test::thrownBy([&] { findBaseRadius(test::ballField(4, 8), 0); }).message,
                         "`longest`"));
}

TEST_CASE("findBaseRadius: same bits for any number of threads, and cancels", "[relief][determinism]") {
    const BrickField scan = test::waveField({80, 8, 80}, 12, 1);
    const BaseScale one = findBaseRadius(scan, 80, 3, test::onThreads(1)),
                    many = findBaseRadius(scan, 80, 3, test::onThreads(8));
    CHECK(one.deviation == many.deviation);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { findBaseRadius(scan, 80, 3, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
