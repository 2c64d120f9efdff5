#include "libvdbsynth/texture/point_hybrid.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("featureSize: by hand on stripes and noise") {
    CHECK(featureSize(test::noiseSample(64, 3, false)) == 1);  // one texel apart nothing is correlated
    CHECK(featureSize({8, 8, 1, false, std::vector<float>(64, 0.5f)}) == 1);
    // Upright stripes 12 texels wide: 1 - lag / 6 across them, 1 along, so 1 - lag / 12 in the mean.
    SampleImage stripes{96, 96, 1, false, {}};
    for (int i = 0; i < 96 * 96; ++i) stripes.values.push_back(i % 24 < 12 ? 0.f : 1.f);
    CHECK(featureSize(stripes) == 11);
    CHECK(featureSize({1, 1, 1, false, {0.5f}}) == 1);
    // Means over 3 x 3 are correlated 2 texels apart (1/3), not 3.
    CHECK(featureSize(test::cloudSample(96, 3, false)) == 3);
}

TEST_CASE("typicalWindow: the one most like the whole") {
    SampleImage sample = test::noiseSample(64, 1, false);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 32; ++x) sample.values[std::size_t(y * 64 + x)] = 0.5f;  // half is flat
    const SampleWindow window = typicalWindow(sample, 16);
    CHECK(window.width == 16);
    CHECK(window.x > 16);
    CHECK(window.x < 32);
    CHECK(typicalWindow(sample, 100).width == 64);
    CHECK(typicalWindow(sample, 100).x == 0);
}

TEST_CASE("texturePointsHybrid: no point is mixed, matched ones have a texel's own colour") {
    const SampleImage sample = test::cloudSample(48, 3, false);
    const TextureTarget target = test::targetOf(test::spiralSphere(12000, 1));
    for (const int levels : {1, 3}) {
        PointHybridOptions options;
        options.levels = levels;
        options.matchSample = 24;
        options.featureSize = 8;
        const PointHybridResult result = texturePointsHybrid(target, sample, options);
        const SampleWindow window = typicalWindow(sample, 24);
        CHECK(result.gaps > 0);
        CHECK(result.widened > result.gaps);
        CHECK(result.tried > 100);
        CHECK(result.tried <= 24 * 24 * 1.4);
        std::size_t matched = 0;
        for (std::size_t i = 0; i < target.point.size(); ++i) {
            REQUIRE(result.sites.sample[i] == 0);
            REQUIRE_FALSE(result.sites.blended[i]);
            REQUIRE(length(result.sites.tangent[i]) == Approx(1).epsilon(1e-4));
            const Vec2f at = result.sites.coordinate[i];
            if (!result.matched[i]) continue;
            ++matched;
            REQUIRE((at.x > float(window.x) && at.x < float(window.x + 24)));
            REQUIRE(result.sites.values[3 * i] == nearestTexel(sample, at)[0]);
        }
        CHECK(matched == result.widened);
        const double ratio = test::contrast(result.sites.values, 3, 1) / test::contrast(sample.values, 3, 1);
        CHECK(ratio > 0.85);
        CHECK(ratio < 1.15);
    }
}

TEST_CASE("texturePointsHybrid: gaps widen by sqrt(k) a step to the feature size") {
    const SampleImage sample = test::cloudSample(48, 1, false);
    const TextureTarget target = test::targetOf(test::spiralSphere(12000, 1));
    const auto widened = [&](double size) {
        PointHybridOptions options;
        options.featureSize = size;
        options.coherent = true;
        const PointHybridResult result = texturePointsHybrid(target, sample, options);
        CHECK(result.featureSize == size);
        return std::pair<std::size_t, std::size_t>(result.gaps, result.widened);
    };
    const auto none = widened(2.5), one = widened(7.5), two = widened(10.1), all = widened(500);
    CHECK(none.second == none.first);
    CHECK(one.second > none.second);
    CHECK(two.second > one.second);
    CHECK(all.second == 12000);
}

TEST_CASE("texturePointsHybrid: a plane and a tileable sample have no gaps to match") {
    const SampleImage sample = test::cloudSample(32, 3, true);
    const PointHybridResult result = texturePointsHybrid(test::targetOf(test::latticePlane(30)), sample);
    CHECK(result.patches == 1);
    CHECK(result.widened == 0);
    CHECK(result.tried == 0);
    CHECK(result.featureSize == featureSize(sample));
}

TEST_CASE("texturePointsHybrid: degenerate targets and samples are coloured") {
    const std::vector<Vec3f> up(3, {0, 0, 1});
    std::vector<TextureTarget> targets;
    targets.push_back({{{0, 0, 0}}, {{0, 0, 1}}, {}, {}});
    targets.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, up, {}, {}});
    targets.push_back({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, up, {}, {}});
    targets.push_back({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, up, {}, {}});
    targets.push_back(test::targetOf(test::spiralSphere(300, 1)));
    const SampleImage one{1, 1, 1, false, {0.3f}};
    for (const TextureTarget& target : targets)
        for (const int levels : {1, 3}) {
            PointHybridOptions options;
            options.levels = levels;
            const PointHybridResult result = texturePointsHybrid(target, one, options);
            for (std::size_t i = 0; i < target.point.size(); ++i) REQUIRE(result.sites.values[i] == 0.3f);
        }
}

TEST_CASE("texturePointsHybrid: bad arguments, cancel, threads") {
    const TextureTarget target = test::targetOf(test::spiralSphere(6000, 1));
    const SampleImage sample = test::cloudSample(32, 3, false);
    const auto call = [&](const PointHybridOptions& options) {
        texturePointsHybrid(target, sample, options);
    };
    const auto refused = [&](const char* field, const auto& change) {
        test::requireRefused<PointHybridOptions>(call, field, change);
    };
    refused("levels", [](PointHybridOptions& o) { o.levels = 0; });
    refused("featureSize", [](PointHybridOptions& o) { o.featureSize = -1; });
    refused("matchSample", [](PointHybridOptions& o) { o.matchSample = 3; });
    refused("patchSize", [](PointHybridOptions& o) { o.parameterization.patchSize = 0; });
    CHECK(texturePointsHybrid(target, sample, {}, test::onThreads(1)).sites.values ==
          texturePointsHybrid(target, sample, {}, test::onThreads(4)).sites.values);
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { texturePointsHybrid(target, sample, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
