#include "libvdbsynth/distance/normalize_band.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

BrickField plane(float slope) {
    return test::fieldFrom(
        {12, 12, 24}, [=](const Index3& p) { return std::clamp((float(p.z) - 11.3f) * slope, -3.f, 3.f); });
}

BrickField ball(float slope) {
    return test::fieldFrom({40, 40, 40}, [=](const Index3& p) {
        const double d = length(Vec3d{p.x - 19.2, p.y - 19.7, p.z - 20.1}) - 12.4;
        return std::clamp(float(d) * slope, -3.f, 3.f);
    });
}

bool besideSurface(const BrickField& field, const Index3& p) {
    return std::any_of(kFaceNeighbours.begin(), kFaceNeighbours.end(),
                       [&](const Index3& step) { return (field.at(p + step) < 0) != (field.at(p) < 0); });
}

// Every voxel beside the surface has all of its neighbours in the band.
std::size_t outOfBand(const BrickField& field, float limit) {
    std::size_t out = 0;
    forEachVoxel(field.box(), [&](const Index3& p) {
        if (!besideSurface(field, p)) return;
        for (const Index3& step : kFaceNeighbours) out += std::abs(field.at(p + step)) >= limit ? 1 : 0;
    });
    return out;
}

}  // namespace

TEST_CASE("normalizeBand: a distance stays, a plane of another slope becomes one beside the surface",
          "[distance][oracle]") {
    for (const float slope : {0.4f, 0.7f, 1.f, 2.f}) {
        const BrickField field = normalizeBand(plane(slope), 3.f);
        for (int z = 0; z < 24; ++z) {
            const float expected = float(z) - 11.3f, margin = slope == 1 ? 1e-5f : 1e-4f;
            if (slope != 1 && std::abs(expected) > 2) continue;
            CAPTURE(slope, z);
            CHECK(field.at({5, 6, z}) == Approx(std::clamp(expected, -3.f, 3.f)).margin(margin));
        }
    }
}

TEST_CASE("normalizeBand: a ball's values are distances to first order, and its level is where it was",
          "[distance][oracle]") {
    for (const float slope : {0.5f, 1.f, 1.7f}) {
        const BrickField given = ball(slope), field = normalizeBand(given, 3.f);
        std::size_t near = 0;
        forEachVoxel(field.box(), [&](const Index3& p) {
            REQUIRE((field.at(p) < 0) == (given.at(p) < 0));
            REQUIRE(std::abs(field.at(p)) <= 3);
            const double d = length(Vec3d{p.x - 19.2, p.y - 19.7, p.z - 20.1}) - 12.4;
            if (std::abs(d) > 0.7) return;
            REQUIRE(double(field.at(p)) == Approx(d).margin(0.2));
            ++near;
        });
        CHECK(near > 2000);
    }
}

TEST_CASE("normalizeBand: every voxel beside the surface has all of its neighbours in the band",
          "[distance][property]") {
    CHECK(outOfBand(ball(3.f), 3.f) > 0);  // too steep: the band ends beside the surface
    CHECK(outOfBand(normalizeBand(ball(3.f), 3.f), 3.f) == 0);
    CHECK(outOfBand(normalizeBand(test::ballsField({40, 40, 40}, 6, 3.f), 3.f), 3.f) == 0);
    CHECK(outOfBand(normalizeBand(test::noiseField({20, 20, 20}, 6), 3.f), 3.f) == 0);
}

TEST_CASE("normalizeBand: turns with the field, and has nothing to do without a surface",
          "[distance][property][degenerate]") {
    const BrickField given = test::ballsField({24, 24, 24}, 2, 3.f);
    const BrickField turned = test::fieldFrom({24, 24, 24}, [&](const Index3& p) {
        return -given.at({p.x, p.y, p.z});
    });
    const BrickField field = normalizeBand(given, 3.f), other = normalizeBand(turned, 3.f);
    forEachVoxel(field.box(), [&](const Index3& p) { REQUIRE(other.at(p) == -field.at(p)); });
    for (const float value : {-3.f, 3.f}) {
        const BrickField none = normalizeBand(BrickField(given.box(), value), 3.f);
        CHECK(none.storedBricks() == 0);
        CHECK(none.at({4, 4, 4}) == value);
    }
    const BrickField one = normalizeBand(BrickField(IndexBox::fromSize({1, 1, 1}), -0.5f), 3.f);
    CHECK(one.at({0, 0, 0}) < 0);
}

TEST_CASE("normalizeBand: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const BrickField field = test::ballsField({70, 60, 50}, 3, 3.f);
    const auto made = [&](const RunContext& ctx) { return normalizeBand(field, 3.f, ctx); };
    CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
}
