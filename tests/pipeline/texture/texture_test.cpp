#include "libvdbsynth/pipeline/texture/texture.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <catch2/catch.hpp>

#include <cstring>

#include "tests/support/contexts.h"
#include "tests/support/level_sets.h"
#include "tests/support/texture_makers.h"

using namespace vdbsynth;

namespace {

TextureOptions withDirection(DirectionSource::Kind kind) {
    TextureOptions options;
    options.direction = DirectionSource{};
    options.direction->kind = kind;
    return options;
}

// Largest |tangent . wanted| deviation from 1 over the sites where the direction lies on the surface.
double worstAlong(const TextureShape& shape, const TextureResult& result, const Vec3f& direction) {
    double worst = 0;
    for (std::size_t i = 0; i < shape.site.size(); ++i) {
        const Vec3f on = direction - shape.normal[i] * dot(direction, shape.normal[i]);
        if (length(on) < 0.9f) continue;
        worst = std::max(worst, 1 - double(dot(normalized(on), result.sites.tangent[i])));
    }
    return worst;
}

}  // namespace

TEST_CASE("textureShape: every site of a sphere gets a colour of the sample", "[pipeline]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 4));
    const std::vector<TextureSample> samples{test::rampSample(32, 32)};
    const TextureResult result = textureShape(shape, samples, {}, {});
    REQUIRE(result.sites.sample.size() == shape.site.size());
    REQUIRE(result.sites.values.size() == 3 * shape.site.size());
    CHECK(result.texel > 0);
    for (std::size_t i = 0; i < shape.site.size(); ++i) {
        REQUIRE(result.sites.sample[i] == 0);
        REQUIRE(std::abs(dot(result.sites.tangent[i], shape.normal[i])) < 1e-3f);
        for (std::size_t c = 0; c < 3; ++c) {
            REQUIRE(result.sites.values[3 * i + c] >= -0.01f);
            REQUIRE(result.sites.values[3 * i + c] <= 1.01f);
        }
    }
    TextureOptions larger;
    larger.scale = 2;
    CHECK(textureShape(shape, samples, {}, larger).texel == Approx(2 * result.texel));
}

TEST_CASE("textureShape: tangents follow a given direction", "[pipeline]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 4));
    const std::vector<TextureSample> samples{test::rampSample(32, 32)};
    TextureOptions options = withDirection(DirectionSource::Kind::Axis);
    options.direction->axis = {1, 0, 0};
    CHECK(worstAlong(shape, textureShape(shape, samples, {}, options), {1, 0, 0}) < 0.02);
    CHECK_NOTHROW(textureShape(shape, samples, {}, withDirection(DirectionSource::Kind::Around)));
    CHECK_NOTHROW(textureShape(shape, samples, {}, withDirection(DirectionSource::Kind::Automatic)));
    // Along the normals of a ball.
    CHECK(test::thrownBy([&] {
              textureShape(shape, samples, {}, withDirection(DirectionSource::Kind::Radial));
          }).code == int(ErrorCode::Unusable));
    TextureOptions strokes = withDirection(DirectionSource::Kind::Strokes);
    strokes.direction->strokes = {{{0, 0, 1}, {0, 1, 0}}};
    CHECK_NOTHROW(textureShape(shape, samples, {}, strokes));
}

TEST_CASE("textureShape: regions take their samples", "[pipeline]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 3));
    std::vector<TextureSample> samples{test::rampSample(16, 16), test::rampSample(16, 16)};
    std::vector<std::int32_t> labels;
    for (const Vec3f& p : shape.site) labels.push_back(p.x > 0);
    const TextureResult result = textureShape(shape, samples, labels, {});
    CHECK(result.sites.sample == labels);
}

TEST_CASE("textureShape: options out of range are refused before the work", "[pipeline][error]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 1));
    const std::vector<TextureSample> samples{test::rampSample(8, 8)};
    const auto thrown = [&](const TextureOptions& options) {
        return test::thrownBy([&] { textureShape(shape, samples, {}, options); });
    };
    for (double scale : {0.0, -1.0, 1e9}) {
        TextureOptions options;
        options.scale = scale;
        CHECK(test::contains(thrown(options).message, "`scale`"));
    }
    TextureOptions options;
    options.neighbours = 2;
    CHECK(test::contains(thrown(options).message, "`neighbours`"));
    options = {};
    options.levels = 13;
    CHECK(test::contains(thrown(options).message, "`levels`"));
    options = {};
    options.regionBlend = 1001;
    CHECK(test::contains(thrown(options).message, "`regionBlend`"));
    options = {};
    options.matchSample = 1;
    CHECK(test::contains(thrown(options).message, "`matchSample`"));
    CHECK(thrown(withDirection(DirectionSource::Kind::Grid)).code == int(ErrorCode::InvalidOption));
    CHECK(thrown(withDirection(DirectionSource::Kind::Strokes)).code == int(ErrorCode::InvalidOption));
    CHECK_NOTHROW(validate(TextureOptions{}));
}

TEST_CASE("textureShape: same bits for any number of threads, and it stops",
          "[pipeline][determinism][cancel]") {
    const TextureShape shape = test::shapeOf(test::sphereMesh(1, 4));
    const std::vector<TextureSample> samples{test::rampSample(32, 32)};
    const auto on = [&](int threads) {
        return textureShape(shape, samples, {}, {}, test::onThreads(threads)).sites.coordinate;
    };
    const auto one = on(1), three = on(3);
    CHECK(std::memcmp(one.data(), three.data(), one.size() * sizeof(Vec2f)) == 0);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              textureShape(shape, samples, {}, {}, ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("displace: elements move along normals, sites stay", "[pipeline]") {
    TextureShape shape = test::shapeOf(test::squareMesh(3));
    const std::vector<TextureSample> samples{test::rampSample(8, 8, 2)};  // map1 is 0.5 everywhere
    const TextureResult result = test::flatResult(shape, samples[0]);
    displace(shape, result, samples, "map1", 4);
    for (const Vec3f& p : shape.points) CHECK(p.z == Approx(2));
    CHECK(shape.site[4].z == 0);
    CHECK(shape.placed()[4].z == Approx(2));
    CHECK(test::thrownBy([&] { displace(shape, result, samples, "no", 1); }).code ==
          int(ErrorCode::InvalidOption));
    CHECK(test::contains(test::thrownBy([&] { displace(shape, result, samples, "map1", 1e300); }).message,
                         "`amplitude`"));
    CHECK(imagesOf(samples).size() == 1);
}
