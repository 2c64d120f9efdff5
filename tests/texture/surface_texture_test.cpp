#include "libvdbsynth/texture/surface_texture.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/sample_images.h"
#include "tests/texture/texture_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace vdbsynth;

TEST_CASE("textureSurface: values are the sample's texels at the coordinates") {
    const SampleImage noise = test::noiseSample(40, 40);
    const TextureTarget target = test::targetOf(test::spiralSphere(5000, 10));
    SurfaceTextureOptions options;
    options.blend = SampleBlend::Off;
    const SurfaceTextureResult result = textureSurface(target, {noise}, options);
    CHECK(result.blended == 0);
    REQUIRE(result.sites.values.size() == 5000);
    for (std::size_t i = 0; i < 5000; ++i) {
        REQUIRE(result.sites.values[i] == nearestTexel(noise, result.sites.coordinate[i])[0]);
        REQUIRE(result.sites.sample[i] == 0);
        REQUIRE(std::abs(dot(result.sites.tangent[i], target.normal[i])) < 1e-4f);
    }
    // A texel is the mean distance to the nearest point.
    const SurfaceSites sites = sitesOfPoints(target.point, target.normal, 1);
    CHECK(result.texel == Approx(meanNearestDistance(sites)));
}

TEST_CASE(
    "textureSurface: colours are mixed where charts meet, of stochastic samples unless told otherwise") {
    const SampleImage noise = test::noiseSample(64, 64), stripes = test::stripesSample(64, 8);
    const TextureTarget target = test::targetOf(test::spiralSphere(6000, 10));
    const SurfaceTextureResult mixed = textureSurface(target, {noise});
    CHECK(mixed.blended > 0);
    CHECK(std::size_t(std::count(mixed.sites.blended.begin(), mixed.sites.blended.end(), char(1))) ==
          mixed.blended);
    for (std::size_t i = 0; i < 6000; ++i)
        if (!mixed.sites.blended[i])
            REQUIRE(mixed.sites.values[i] == nearestTexel(noise, mixed.sites.coordinate[i])[0]);
    CHECK(textureSurface(target, {stripes}).blended == 0);
    SurfaceTextureOptions always;
    always.blend = SampleBlend::Histogram;
    CHECK(textureSurface(target, {stripes}, always).blended > 0);
}

TEST_CASE("textureSurface: given directions are the tangents") {
    TextureTarget target = test::targetOf(test::latticePlane(30));
    target.direction.assign(900, {0, 1, 0});
    const SurfaceTextureResult result = textureSurface(target, {test::noiseSample(16, 16)});
    for (const Vec3f& t : result.sites.tangent) REQUIRE(t.y == Approx(1));
    CHECK(result.singularities.empty());
}

TEST_CASE("textureSurface: points at one place that face one way get one colour, others their own") {
    TextureTarget target = test::targetOf(test::latticePlane(20));
    for (int i = 0; i < 400; ++i) {
        target.point.push_back(target.point[std::size_t(i)]);
        target.normal.push_back({0, 0, i % 2 ? 1.0f : -1.0f});
    }
    const SurfaceTextureResult result = textureSurface(target, {test::noiseSample(32, 32)});
    std::size_t own = 0;
    for (std::size_t i = 0; i < 400; ++i) {
        if (i % 2) REQUIRE(result.sites.values[i] == result.sites.values[400 + i]);
        if (i % 2 == 0) own += result.sites.values[i] != result.sites.values[400 + i];
    }
    CHECK(own > 150);
}

TEST_CASE("textureSurface: scale and texel") {
    const TextureTarget target = test::targetOf(test::latticePlane(40));
    SurfaceTextureOptions options;
    options.scale = 2.5;
    CHECK(textureSurface(target, {test::noiseSample(32, 32)}, options).texel == Approx(2.5));
    options.texel = 0.5;
    CHECK(textureSurface(target, {test::noiseSample(32, 32)}, options).texel == 0.5);
}

TEST_CASE("textureSurface: refusals, threads, cancel") {
    const SampleImage noise = test::noiseSample(16, 16);
    const TextureTarget target = test::targetOf(test::latticePlane(10));
    const auto code = [&](const TextureTarget& t, const SurfaceTextureOptions& options = {}) {
        return test::thrownBy([&] { textureSurface(t, {noise}, options); }).code;
    };
    CHECK(code({}) == int(ErrorCode::EmptyInput));
    TextureTarget bad = target;
    bad.normal.pop_back();
    CHECK(code(bad) == int(ErrorCode::ShapeMismatch));
    bad = target;
    bad.normal[3] = {0, 0, 0};
    CHECK(code(bad) == int(ErrorCode::Unusable));
    bad = target;
    bad.point[3].x = std::numeric_limits<float>::quiet_NaN();
    CHECK(code(bad) == int(ErrorCode::Unusable));
    bad = target;
    bad.direction.assign(100, {0, 0, 1});
    CHECK(code(bad) == int(ErrorCode::Unusable));
    SurfaceTextureOptions options;
    options.scale = 0;
    CHECK(code(target, options) == int(ErrorCode::InvalidOption));
    options = {};
    options.texel = -1;
    CHECK(code(target, options) == int(ErrorCode::InvalidOption));
    options = {};
    options.blend = SampleBlend::Weight;
    CHECK(code(target, options) == int(ErrorCode::InvalidOption));
    const TextureTarget ball = test::targetOf(test::spiralSphere(3000, 10));
    CHECK(textureSurface(ball, {noise}, {}, test::onThreads(1)).sites.values ==
          textureSurface(ball, {noise}, {}, test::onThreads(4)).sites.values);
    const auto thrown =
        test::thrownWhenCancelled([&](const RunContext& ctx) { textureSurface(target, {noise}, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
