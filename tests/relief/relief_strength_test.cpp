#include "libvdbsynth/relief/relief_strength.h"

#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "tests/relief/relief_shapes.h"
#include "tests/support/contexts.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

BaseSurface bumpyBall() {
    const int side = 121;
    const BrickField scan = test::fieldFrom({side, side, side}, [](const Index3& p) {
        const double x = p.x - 60, y = p.y - 60, z = p.z - 60;
        const double bump = 1.5 * sine(0.5 * x) * sine(0.5 * y + 1) * sine(0.5 * z);
        return float(std::clamp((std::sqrt(x * x + y * y + z * z) - 28 - bump) / 1.2, -3.0, 3.0));
    });
    BaseOptions options;
    options.radius = 4;
    return baseSurface(scan, options);
}

// Largest distance of one field's zero level from another field's.
double farthest(const BrickField& from, const BrickField& to) {
    double most = 0;
    for (const Vec3f& p : zeroLevel(from, from.box(), Facing::Outward).points)
        most = std::max(most, std::abs(double(sampleTrilinear(to, p))));
    return most;
}

}  // namespace

TEST_CASE("reliefSurface: base and relief add up to the scan", "[relief][property]") {
    const BaseSurface base = bumpyBall();
    REQUIRE(base.amplitude > 1);
    const BrickField again = reliefSurface(base, 1);
    CHECK(farthest(again, base.scan) < 0.1);
    CHECK(farthest(base.scan, again) < 0.1);
}

TEST_CASE("reliefSurface: what a base lost is there again at strength 1", "[relief][property]") {
    // A ball with a thin pin that no base of this radius keeps.
    const BrickField scan = test::fieldFrom({120, 100, 100}, [](const Index3& p) {
        const double x = p.x - 50., y = p.y - 50., z = p.z - 50.;
        const double ball = std::sqrt(x * x + y * y + z * z) - 22;
        const double pin = std::max(std::sqrt(y * y + z * z) - 2, std::max(-x, x - 40));
        return float(std::clamp(std::min(ball, pin), -3.0, 3.0));
    });
    BaseOptions options;
    options.radius = 4;
    const BaseSurface base = baseSurface(scan, options);
    CHECK(base.distance.at({88, 50, 50}) > 0);
    CHECK(base.beyond > 0.01);
    const BrickField again = reliefSurface(base, 1);
    std::size_t wrong = 0;
    forEachVoxel(scan.box(), [&](const Index3& p) {
        wrong += std::abs(scan.at(p)) > 0.1f && (scan.at(p) < 0) != (again.at(p) < 0);
    });
    CHECK(wrong == 0);
}

TEST_CASE("reliefSurface: no strength is the base, a negative one inverts", "[relief][property]") {
    BaseSurface base;
    base.reach = 6;
    base.distance = test::groundField({64, 16, 40}, [](double, double) { return 0.0; });
    base.scan = test::waveField({64, 16, 40}, 32, 1.5);
    CHECK(test::samplesOf(reliefSurface(base, 0)) == test::samplesOf(base.distance));
    for (const double strength : {-1.0, 0.5, 2.0}) {
        CAPTURE(strength);
        const BrickField wanted = test::waveField({64, 16, 40}, 32, 1.5 * strength);
        const BrickField made = reliefSurface(base, strength);
        double most = 0;
        for (const Vec3f& p : zeroLevel(made, made.box(), Facing::Outward).points)
            if (p.x > 8 && p.x < 55) most = std::max(most, std::abs(double(sampleTrilinear(wanted, p))));
        CHECK(most < 0.1);
    }
}

TEST_CASE("reliefSurface: a strength out of range is refused", "[relief][error]") {
    const BaseSurface base;
    for (const double strength : {-101.0, 101.0, std::nan("")}) {
        const test::Thrown thrown = test::thrownBy([&] { reliefSurface(base, strength); });
        CHECK(thrown.code == int(ErrorCode::InvalidOption));
        CHECK(test::contains(thrown.message, "`strength`"));
    }
}

TEST_CASE("reliefSurface: same bits for any number of threads, and cancels", "[relief][determinism]") {
    BaseSurface base;
    base.distance = test::groundField({32, 16, 40}, [](double, double) { return 0.0; });
    base.scan = test::waveField({32, 16, 40}, 16, 1);
    CHECK(test::samplesOf(reliefSurface(base, 1.5, test::onThreads(1))) ==
          test::samplesOf(reliefSurface(base, 1.5, test::onThreads(8))));
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) { reliefSurface(base, 1, ctx); }).code ==
          int(ErrorCode::Cancelled));
}
