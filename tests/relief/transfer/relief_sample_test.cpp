#include "libvdbsynth/relief/transfer/relief_sample.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

// Waves along x on a plane.
std::shared_ptr<const BaseSurface> waves(double wavelength, double amplitude) {
    auto base = std::make_shared<BaseSurface>();
    base->reach = 6;
    base->amplitude = amplitude;
    base->distance = test::groundField({96, 64, 40}, [](double, double) { return 0.0; });
    base->scan = test::waveField({96, 64, 40}, wavelength, amplitude);
    return base;
}

std::vector<Vec3f> alongX(const std::vector<Vec3f>& place, const std::vector<Vec3f>&) {
    return std::vector<Vec3f>(place.size(), {1, 0, 0});
}

}  // namespace

TEST_CASE("reliefSample: waves on a plane are one chart of waves") {
    const ReliefSample sample = reliefSample(waves(24, 1.5), alongX);
    CHECK(sample.charts == 1);
    CHECK(sample.covered > 0.97);
    CHECK_FALSE(sample.folds);
    CHECK(sample.lowest == Approx(-1.5).margin(0.05));
    CHECK(sample.highest == Approx(1.5).margin(0.05));
    REQUIRE(sample.image.channels == 1);
    std::size_t valid = 0;
    for (std::size_t i = 0; i < sample.image.texels(); ++i) {
        if (!sample.image.valid[i]) continue;
        ++valid;
        REQUIRE(sample.known[i]);
        // Foot, normal and height belong together: the surface is there.
        const Vec3f on = sample.place[i] + sample.normal[i] * sample.image.values[i];
        REQUIRE(std::abs(sampleTrilinear(sample.surface->scan, on)) < 0.05f);
    }
    CHECK(valid > 80 * 50);
    // u runs along x: a texel to the right is a voxel along x.
    const int x = sample.image.width / 2, y = sample.image.height / 2;
    const std::size_t here = std::size_t(y * sample.image.width + x);
    CHECK(sample.place[here + 1].x - sample.place[here].x == Approx(1).margin(0.02));
    CHECK(sample.place[here + 1].y - sample.place[here].y == Approx(0).margin(0.02));
}

TEST_CASE("reliefDistance: of waves the distance to first order") {
    const ReliefSample sample = reliefSample(waves(24, 1.5), alongX);
    const int x = sample.image.width / 2, y = sample.image.height / 2;
    const std::size_t here = std::size_t(y * sample.image.width + x);
    const Vec2f at{float(x) + 0.5f, float(y) + 0.5f};
    for (float depth : {-1.0f, 0.0f, 0.7f}) {
        const Vec3f place = sample.place[here] + sample.normal[here] * depth;
        CHECK(reliefDistance(sample, at, depth) ==
              Approx(sampleTrilinear(sample.surface->scan, place)).margin(0.12));
    }
}

TEST_CASE("reliefSample: a picture of heights") {
    SampleImage heights{4, 2, 1, true, {0, 1, 2, 3, 0, -1, -2, -3}};
    const ReliefSample sample = reliefSample(heights);
    CHECK(sample.lowest == -3);
    CHECK(sample.highest == 3);
    CHECK(sample.surface == nullptr);
    SampleImage flat{8, 8, 1, true, std::vector<float>(64, 2)};
    CHECK(reliefDistance(reliefSample(flat), {3, 3}, 5) == Approx(3));

    CHECK_THROWS_AS(reliefSample(SampleImage{}), Error);
    CHECK_THROWS_AS(reliefSample(SampleImage{1, 1, 2, false, {0, 0}}), Error);
    CHECK_THROWS_AS(reliefSample(SampleImage{1, 1, 1, false, {NAN}}), Error);
    // What is not valid may be anything.
    CHECK_NOTHROW(reliefSample(SampleImage{2, 1, 1, false, {NAN, 1}, {0, 1}}));
}

TEST_CASE("reliefSample: an overhang folds, and its distances are copied") {
    auto base = std::make_shared<BaseSurface>();
    base->reach = 8;
    base->amplitude = 5;
    base->distance = test::groundField({64, 64, 40}, [](double, double) { return 0.0; });
    // A T along y on the plane: a stem of 6, a bar of 16 by 3, at 4 to 7 above.
    base->scan = test::fieldFrom({64, 64, 40}, [&](const Index3& p) {
        const float z = float(p.z) - 20;
        const float x = std::abs(float(p.x) - 32);
        const auto box = [](float across, float along) {
            return std::max(across, along) > 0 ? std::hypot(std::max(across, 0.f), std::max(along, 0.f))
                                               : std::max(across, along);
        };
        const float stem = box(x - 3, z - 5), bar = box(x - 8, std::abs(z - 5.5f) - 1.5f);
        return std::clamp(std::min({z, stem, bar}), -8.f, 8.f);
    });
    const ReliefSample sample = reliefSample(base, alongX);
    CHECK(sample.folds);
    CHECK(sample.image.channels == 3);
    std::size_t hollow = 0;
    for (std::size_t i = 0; i < sample.image.texels(); ++i) {
        if (!sample.image.valid[i] || std::abs(sample.place[i].x - 32) > 7 ||
            std::abs(sample.place[i].x - 32) < 4)
            continue;
        const Vec2f at{float(i % std::size_t(sample.image.width)) + 0.5f,
                       float(i / std::size_t(sample.image.width)) + 0.5f};
        hollow += reliefDistance(sample, at, 5.5f) < 0 && reliefDistance(sample, at, 2) > 0;
    }
    CHECK(hollow > 6 * 40);
}

TEST_CASE("reliefSample: no base, too large, threads, cancel") {
    auto none = std::make_shared<BaseSurface>();
    none->distance = none->scan = BrickField(IndexBox::fromSize({8, 8, 8}), 3);
    CHECK_THROWS_AS(reliefSample(none, nullptr), Error);
    ReliefSampleOptions small;
    small.largest = 100;
    CHECK_THROWS_AS(reliefSample(waves(24, 1), nullptr, small), Error);
    const ReliefSample one = reliefSample(waves(24, 1), nullptr, {}, test::onThreads(1)),
                       four = reliefSample(waves(24, 1), nullptr, {}, test::onThreads(4));
    CHECK(one.image.values == four.image.values);
    CHECK(one.image.valid == four.image.valid);
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { reliefSample(waves(24, 1), nullptr, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}
