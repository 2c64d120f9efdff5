#include "libvdbsynth/coordinates/sample_features.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/sample_images.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

TEST_CASE("smoothed: keeps the mean, spreads a point as a Gaussian, leaves tiny sigmas alone") {
    SampleImage point{21, 21, 1, false, std::vector<float>(441, 0)};
    point.values[10 * 21 + 10] = 1;
    const SampleImage wide = smoothed(point, 2);
    double sum = 0, variance = 0;
    for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 21; ++x) {
            sum += double(wide.texel(x, y)[0]);
            variance += double(wide.texel(x, y)[0]) * (x - 10) * (x - 10);
        }
    CHECK(sum == Approx(1).epsilon(1e-4));
    CHECK(std::sqrt(variance) == Approx(2).epsilon(0.05));
    CHECK(smoothed(point, 0.2).values == point.values);
}

TEST_CASE("sampleLevel: equal windows have equal features, and similar nodes are far away and alike") {
    const SampleImage stripes = test::stripesSample(64, 4);
    const SampleLevel level = sampleLevel(stripes, 1, 2);
    CHECK(level.stride == 1);
    CHECK(level.width == 64);
    CHECK(level.margin == 1);
    // The middle of a white stripe is nearer to the middle of the next white one than to a black one's.
    const auto distance = [&](int a, int b) {
        double sum = 0;
        for (std::size_t d = 0; d < kFeature; ++d) {
            const float f =
                level.feature[std::size_t(a) * kFeature + d] - level.feature[std::size_t(b) * kFeature + d];
            sum += double(f * f);
        }
        return sum;
    };
    CHECK(distance(32 * 64 + 21, 32 * 64 + 29) < 0.1 * distance(32 * 64 + 21, 32 * 64 + 25));
    std::size_t found = 0;
    for (int node = 0; node < 64 * 64; ++node)
        for (std::size_t k = 0; k < 2; ++k) {
            const std::int32_t like = level.similar[std::size_t(node) * 2 + k];
            if (like < 0) continue;
            ++found;
            const int apart = std::max(std::abs(like % 64 - node % 64), std::abs(like / 64 - node / 64));
            REQUIRE(apart >= 3);
            REQUIRE(distance(node, like) < level.spread);
        }
    CHECK(found > 62 * 62);
}

TEST_CASE("sampleLevel: nodes and margins by hand") {
    SampleLevel level = sampleLevel(test::noiseSample(40, 24), 4, 0);
    CHECK(level.stride == 2);
    CHECK(level.width == 20);
    CHECK(level.height == 12);
    CHECK(level.margin == 2);
    CHECK(level.node({0.5f, 0.5f}) == 0);
    CHECK(level.node({2, 2}) == 21);
    CHECK(level.centre(21).x == 3);
    CHECK_FALSE(level.isSource({3.9f, 10}));
    CHECK(level.isSource({4, 10}));
    CHECK_FALSE(level.isSource({36, 10}));
    SampleImage tile = test::noiseSample(40, 24);
    tile.tileable = true;
    level = sampleLevel(tile, 4, 0);
    CHECK(level.margin == 0);
    CHECK(level.isSource({-100, 1000}));
    CHECK(level.node({-0.5f, 0.5f}) == 19);
}

TEST_CASE("sampleLevel: ranks part every channel's values evenly") {
    const SampleLevel level = sampleLevel(test::noiseSample(64, 64), 1, 0);
    std::vector<int> count(kRanks);
    for (std::uint8_t rank : level.rank) ++count[rank];
    for (int c : count) CHECK(c == 64 * 64 / 16);
    const SampleLevel flat = sampleLevel({8, 8, 1, false, std::vector<float>(64, 0.5f)}, 1, 2);
    CHECK(std::all_of(flat.rank.begin(), flat.rank.end(), [](std::uint8_t r) { return r == 0; }));
    CHECK(flat.spread == 0);
}

TEST_CASE("sampleLevel: large samples, tiny ones, none, threads, cancel") {
    const SampleLevel large = sampleLevel(test::noiseSample(300, 200), 1, 2);
    std::size_t without = 0;
    for (std::size_t i = 0; i < large.similar.size(); i += 2) without += large.similar[i] < 0;
    CHECK(double(without) < 0.1 * 60000);
    CHECK(sampleLevel({1, 1, 3, false, {1, 0, 0}}, 1, 2).feature.size() == kFeature);
    CHECK(test::thrownBy([] { sampleLevel({}, 1, 2); }).code == int(ErrorCode::EmptyInput));
    const SampleLevel one = sampleLevel(test::noiseSample(64, 64), 2, 2, test::onThreads(1));
    const SampleLevel four = sampleLevel(test::noiseSample(64, 64), 2, 2, test::onThreads(4));
    CHECK(one.feature == four.feature);
    CHECK(one.similar == four.similar);
    const auto thrown = test::thrownWhenCancelled(
        [](const RunContext& ctx) { sampleLevel(test::noiseSample(64, 64), 1, 2, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}

TEST_CASE("sampleLevel: nodes beside texels that are not valid are no sources") {
    SampleImage image = test::noiseSample(40, 24);
    image.valid.assign(image.texels(), 1);
    for (int y = 0; y < 24; ++y)
        for (int x = 20; x < 40; ++x) {
            image.valid[std::size_t(y * 40 + x)] = 0;
            image.texel(x, y)[0] = 0;
        }
    const SampleLevel level = sampleLevel(image, 1, 2);
    CHECK(level.isSource({10.5f, 10.5f}));
    CHECK(level.isSource({18.5f, 10.5f}));
    CHECK_FALSE(level.isSource({19.5f, 10.5f}));  // within a step
    CHECK_FALSE(level.isSource({30.5f, 10.5f}));
    for (std::int32_t node = 0; node < 40 * 24; ++node)
        for (std::size_t k = 0; k < 2 && level.isSource(level.centre(node)); ++k) {
            const std::int32_t like = level.similar[std::size_t(node) * 2 + k];
            if (like >= 0) REQUIRE(level.isSource(level.centre(like)));
        }
    // As if the rest were not there.
    SampleImage half{20, 24, image.channels, false, {}};
    for (int y = 0; y < 24; ++y) half.values.insert(half.values.end(), image.texel(0, y), image.texel(20, y));
    CHECK(level.spread == Approx(sampleLevel(half, 1, 0).spread).epsilon(0.15));

    // Where a margin would leave nothing it is narrower.
    image.valid.assign(image.texels(), 0);
    image.valid[12 * 40 + 12] = 1;
    CHECK(sampleLevel(image, 4, 0).isSource({12.5f, 12.5f}));
    image.valid.assign(image.texels(), 0);
    CHECK_THROWS_AS(sampleLevel(image, 1, 0), Error);
}
