#include "libvdbsynth/relief/relief_statistics.h"

#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

BaseSurface overPlane(const std::function<double(double, double)>& height) {
    BaseSurface base;
    base.reach = 6;
    base.radius = 20;
    base.distance = test::groundField({128, 128, 24}, [](double, double) { return 0.25; });
    base.scan = test::groundField({128, 128, 24}, [=](double x, double y) { return 0.25 + height(x, y); });
    return base;
}

// Whole waves: voxels 16 to 111, which a box holds to half a voxel beyond.
const IndexBox kWhole{{16, 16, 0}, {111, 111, 23}};

}  // namespace

TEST_CASE("reliefStatistics: a sine has the numbers of the formula within one percent", "[relief][oracle]") {
    const double amplitude = 1.2;
    const ReliefStatistics s = reliefStatistics(
        overPlane([=](double x, double) { return amplitude * sine(2 * kPi * x / 32); }), kWhole);
    CHECK(s.sa == Approx(2 * amplitude / kPi).epsilon(0.01));
    CHECK(s.sq == Approx(amplitude / std::sqrt(2.0)).epsilon(0.01));
    CHECK(s.ssk == Approx(0).margin(0.01));
    CHECK(s.sku == Approx(1.5).epsilon(0.01));
    CHECK(s.mean == Approx(0).margin(0.01));
    CHECK(s.highest == Approx(amplitude).epsilon(0.01));
    CHECK(s.lowest == Approx(-amplitude).epsilon(0.01));
    CHECK(s.area == Approx(96 * 96).epsilon(0.03));
    CHECK(s.folded == 0);
    CHECK(s.lost == 0);
}

TEST_CASE("reliefStatistics: a sine over its own base has the transfer function's within one percent",
          "[relief][oracle]") {
    constexpr double kWave = 24, kRadius = 6;
    BaseOptions options;
    options.radius = kRadius;
    const BaseSurface base = baseSurface(test::waveField({192, 32, 64}, kWave, kWave / 40), options);
    const ReliefStatistics s = reliefStatistics(base, {{48, 8, 0}, {143, 23, 63}});
    const double ratio = kCutOff * kRadius / kWave, g = exponential(-0.69314718056 * ratio * ratio);
    const double amplitude = kWave / 40 * (1 - g) * (1 - g);
    CHECK(s.sa == Approx(2 * amplitude / kPi).epsilon(0.01));
    CHECK(s.sq == Approx(amplitude / std::sqrt(2.0)).epsilon(0.01));
    CHECK(s.sku == Approx(1.5).epsilon(0.01));
    CHECK(s.sq * std::sqrt(2.0) == Approx(amplitude).margin(0.002 * kWave / 40));
}

TEST_CASE("reliefStatistics: an egg-crate has the numbers of the formula", "[relief][oracle]") {
    const double amplitude = 1.2;
    const ReliefStatistics s =
        reliefStatistics(overPlane([=](double x, double y) {
                             return amplitude * sine(2 * kPi * x / 32) * sine(2 * kPi * y / 32);
                         }),
                         kWhole);
    CHECK(s.sq == Approx(amplitude / 2).epsilon(0.01));
    CHECK(s.ssk == Approx(0).margin(0.01));
    CHECK(s.sku == Approx(2.25).epsilon(0.01));
}

TEST_CASE("reliefStatistics: octaves hold what their formula says of a wave", "[relief][oracle]") {
    const double wave = GENERATE(12.0, 24.0, 32.0);
    const ReliefStatistics s =
        reliefStatistics(overPlane([=](double x, double) { return wave / 40 * sine(2 * kPi * x / wave); }),
                         {{40, 40, 0}, {87, 87, 23}});
    REQUIRE(s.octaves.size() >= 6);
    const auto passes = [&](double cut) {
        return cut == 0 ? 1 : exponential(-0.69314718 * cut * cut / (wave * wave));
    };
    for (std::size_t i = 0; i < 5; ++i) {
        const ReliefOctave& octave = s.octaves[i];
        CAPTURE(wave, octave.shortest, octave.longest);
        const double share = passes(octave.shortest) - passes(octave.longest);
        CHECK(octave.deviation / s.sq == Approx(share).margin(0.04));
        CHECK(octave.longest == 4 << i);
    }
}

TEST_CASE("reliefStatistics: no relief has zeros, no base is an error", "[relief][fast]") {
    const BaseSurface flat = overPlane([](double, double) { return 0.0; });
    const ReliefStatistics s = reliefStatistics(flat, kWhole);
    CHECK(s.sa == Approx(0).margin(1e-4));
    CHECK(s.ssk == 0);
    CHECK(s.sku == 0);
    CHECK(test::thrownBy([&] {
              reliefStatistics(flat, {{0, 0, 0}, {9, 9, 2}});
          }).code == int(ErrorCode::EmptyInput));
}

TEST_CASE("reliefStatistics: same bits for any number of threads, and cancels", "[relief][determinism]") {
    const BaseSurface base = overPlane([](double x, double y) { return sine(x / 5) * sine(y / 3); });
    const ReliefStatistics one = reliefStatistics(base, {}, test::onThreads(1)),
                           many = reliefStatistics(base, {}, test::onThreads(8));
    CHECK(one.sq == many.sq);
    CHECK(one.sku == many.sku);
    CHECK(one.octaves.back().deviation == many.octaves.back().deviation);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { reliefStatistics(base, {}, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
