#include "libvdbsynth/relief/gaussian_mean.h"

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/contexts.h"
#include "tests/support/makers.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("gaussianMean: a single sample spreads by the weights of the formula", "[relief][fast]") {
    BrickField field(IndexBox::fromSize({33, 33, 33}), 0.f);
    const float one = 1;
    field.writeBox({16, 16, 16}, {1, 1, 1}, &one);
    const BrickField mean = gaussianMean(field, 2);
    double sum = 0;
    for (int i = -8; i <= 8; ++i) sum += exponential(-i * i / 8.0);
    CHECK(mean.at({16, 16, 16}) == Approx(1 / (sum * sum * sum)).epsilon(1e-5));
    CHECK(mean.at({18, 13, 17}) == Approx(exponential(-(4 + 9 + 1) / 8.0) / (sum * sum * sum)).epsilon(1e-5));
}

TEST_CASE("gaussianMean: a linear field stays, a square grows by the variance", "[relief][property]") {
    const double sigma = GENERATE(0.5, 1.0, 2.5, 4.0);
    const auto linear = [](const Index3& p) { return float(p.x) - 2 * float(p.y) + 0.5f * float(p.z); };
    const auto square = [](const Index3& p) { return float(p.y * p.y); };
    const BrickField a = gaussianMean(test::fieldFrom({48, 48, 48}, linear), sigma);
    const BrickField b = gaussianMean(test::fieldFrom({48, 48, 48}, square), sigma);
    CHECK(a.at({24, 22, 25}) == Approx(linear({24, 22, 25})).margin(1e-3));
    CHECK(b.at({24, 22, 25}) == Approx(22 * 22 + sigma * sigma).epsilon(1e-4));
}

TEST_CASE("gaussianMean: a constant field costs no bricks", "[relief][fast]") {
    CHECK(gaussianMean(BrickField(IndexBox::fromSize({40, 40, 40}), 3.f), 5).storedBricks() == 0);
}

TEST_CASE("gaussianMean: sigma out of its range is refused", "[relief][error]") {
    const BrickField field = test::noiseField({8, 8, 8}, 1);
    for (const double sigma : {-1.0, 2001.0, std::nan("")}) {
        const test::Thrown thrown = test::thrownBy([&] { gaussianMean(field, sigma); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`sigma`"));
    }
}

TEST_CASE("gaussianMean: same bits for any number of threads, and cancels", "[relief][determinism]") {
    const BrickField field = test::noiseField({30, 21, 17}, 5);
    CHECK(test::samplesOf(gaussianMean(field, 3, test::onThreads(1))) ==
          test::samplesOf(gaussianMean(field, 3, test::onThreads(8))));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { gaussianMean(field, 3, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
