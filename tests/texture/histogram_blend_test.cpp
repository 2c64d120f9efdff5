#include "libvdbsynth/texture/histogram_blend.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

// Values of a mix of `count` random places, many times.
std::vector<float> mixes(const SampleImage& sample, std::size_t count, int times) {
    const HistogramBlend blend(sample);
    std::vector<float> values(std::size_t(times) * std::size_t(sample.channels));
    for (int i = 0; i < times; ++i) {
        Random random(1, std::uint64_t(i));
        BlendPart parts[kMostBlendParts];
        for (std::size_t p = 0; p < count; ++p)
            parts[p] = {{float(random.below(std::uint32_t(sample.width))) + 0.5f,
                         float(random.below(std::uint32_t(sample.height))) + 0.5f},
                        float(random.uniform(0.3, 1))};
        blend.mix(parts, count, values.data() + std::size_t(i) * std::size_t(sample.channels));
    }
    return values;
}

// Bricks of 16 x 8 texels with joints of 2, every second row by half a brick, and a little noise.
SampleImage bricks(int side) {
    SampleImage image{side, side, 1, false, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const bool joint = y % 8 < 2 || (x + y / 8 % 2 * 8) % 16 < 2;
            image.values.push_back((joint ? 0.9f : 0.3f) +
                                   0.02f * float(Random(8, std::uint64_t(y * side + x)).uniform()));
        }
    return image;
}

}  // namespace

TEST_CASE("normalQuantile: known values and symmetry") {
    CHECK(normalQuantile(0.5) == Approx(0).margin(1e-12));
    CHECK(normalQuantile(0.975) == Approx(1.959963985));
    CHECK(normalQuantile(0.001) == Approx(-3.090232306));
    CHECK(normalQuantile(0.9999) == Approx(-normalQuantile(0.0001)));
}

TEST_CASE("HistogramBlend: one place alone gives its own value") {
    const SampleImage sample = test::cloudSample(48, 3, false);
    const HistogramBlend blend(sample);
    for (int i = 0; i < 40; ++i) {
        const BlendPart part{{float(i) + 0.5f, 20.5f}, 0.7f};
        float out[3];
        blend.mix(&part, 1, out);
        for (int c = 0; c < 3; ++c) REQUIRE(out[c] == Approx(sample.texel(i, 20)[c]).margin(0.01));
    }
}

TEST_CASE("HistogramBlend: mixes of noise keep the contrast") {
    for (const int channels : {1, 3})
        for (const std::size_t count : {2u, 3u, 4u})
            for (const SampleImage& sample :
                 {test::noiseSample(64, channels, false), test::cloudSample(64, channels, true)}) {
                const std::vector<float> values = mixes(sample, count, 20000);
                for (int c = 0; c < channels; ++c) {
                    const double ratio = test::contrast(values, std::size_t(channels), std::size_t(c)) /
                                         test::contrast(sample.values, std::size_t(channels), std::size_t(c));
                    INFO(channels << " channels, " << count << " places: " << ratio);
                    CHECK(ratio > 0.95);
                    CHECK(ratio < 1.05);
                }
            }
}

TEST_CASE("HistogramBlend: flat and tiny samples stay what they are") {
    const SampleImage flat{4, 4, 2, false, std::vector<float>(32, 0.25f)};
    const std::vector<float> values = mixes(flat, 3, 5);
    for (const float v : values) CHECK(v == Approx(0.25f));
    const SampleImage one{1, 1, 3, false, {0.1f, 0.2f, 0.3f}};
    CHECK(mixes(one, 2, 1)[2] == Approx(0.3f));
    SampleImage grey = test::noiseSample(16, 1, false);  // three equal channels: one component
    SampleImage three{16, 16, 3, false, {}};
    for (const float v : grey.values) three.values.insert(three.values.end(), 3, v);
    const std::vector<float> mixed = mixes(three, 2, 100);
    for (std::size_t i = 0; i < 100; ++i) CHECK(mixed[3 * i] == Approx(mixed[3 * i + 2]).margin(1e-5));
    CHECK_THROWS_AS(HistogramBlend(SampleImage{}), Error);
}

TEST_CASE("blendLoss: small for noise, large for bricks") {
    const double noise = blendLoss(test::noiseSample(96, 3, false));
    const double clouds = blendLoss(test::cloudSample(96, 3, false));
    const double wall = blendLoss(bricks(96));
    INFO(noise << " " << clouds << " " << wall);
    CHECK(noise < kBlendSuits);
    CHECK(clouds < kBlendSuits);
    CHECK(wall > 1.5);
    CHECK(blendLoss({1, 1, 1, false, {0.5f}}) == 1);
    CHECK(blendLoss({64, 64, 1, false, std::vector<float>(4096, 0.5f)}) <= kBlendSuits);
}

TEST_CASE("blendLoss: cancel, threads") {
    const SampleImage sample = test::cloudSample(64, 3, false);
    CHECK(blendLoss(sample, test::onThreads(1)) == blendLoss(sample, test::onThreads(4)));
    const auto thrown = test::thrownWhenCancelled([&](const RunContext& ctx) { blendLoss(sample, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
