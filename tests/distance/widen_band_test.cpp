#include "libvdbsynth/distance/widen_band.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

constexpr float kWide = 8;

// A model's band of 3 voxels over a domain of this size, known for `reach` voxels around it.
KnownBand knownOf(const Index3& size, int reach, const std::function<double(const Vec3d&)>& distance) {
    KnownBand known;
    known.domain = IndexBox{{reach, reach, reach}, size + Index3{reach - 1, reach - 1, reach - 1}};
    known.field = test::fieldFrom(size + Index3{2 * reach, 2 * reach, 2 * reach}, [&](const Index3& p) {
        const Vec3d at{double(p.x - reach), double(p.y - reach), double(p.z - reach)};
        return float(std::clamp(distance(at), -3.0, 3.0));
    });
    return known;
}

double ballDistance(const Vec3d& p) {
    return length(p - Vec3d{21.5, 20.5, 22}) - 15.2;
}
double barDistance(const Vec3d& p) {
    return std::hypot(p.y - 19.3, p.z - 19.6) - 1.4;
}

// A rod of radius 9 along x.
BrickField rod() {
    return test::fieldFrom({40, 40, 40}, [](const Index3& p) {
        return float(std::clamp(std::hypot(p.y - 19.5, p.z - 19.5) - 9, -3.0, 3.0));
    });
}

}  // namespace

TEST_CASE("reachToWiden: the band rounded up, and what its mesh needs", "[distance][oracle]") {
    CHECK(reachToWiden(3.f) == 5);
    CHECK(reachToWiden(7.2f) == 10);
    CHECK(reachToWiden(kWide) == 10);
}

TEST_CASE("widenBand: wide distances of a ball are the true ones, the narrow band's its own",
          "[distance][oracle]") {
    const KnownBand known = knownOf({44, 41, 43}, reachToWiden(kWide), ballDistance);
    const BrickField wide = widenBand(known, kWide);
    REQUIRE(wide.box() == IndexBox::fromSize({44, 41, 43}));
    double worst = 0, worstNear = 0;
    forEachVoxel(wide.box(), [&](const Index3& p) {
        const double d = ballDistance({double(p.x), double(p.y), double(p.z)});
        const double off = std::abs(double(wide.at(p)) - std::clamp(d, -8.0, 8.0));
        worst = std::max(worst, off);
        if (std::abs(d) < 1.5) worstNear = std::max(worstNear, off);
    });
    CHECK(worstNear < 1e-4);
    CHECK(worst < 0.1);
}

TEST_CASE("widenBand: a thin bar's own distances stay", "[distance][oracle]") {
    const KnownBand known = knownOf({24, 40, 40}, reachToWiden(kWide), barDistance);
    const BrickField wide = widenBand(known, kWide);
    std::size_t kept = 0, all = 0;
    forEachVoxel(wide.box(), [&](const Index3& p) {
        const double own = barDistance({double(p.x), double(p.y), double(p.z)});
        if (std::abs(own) >= 1) return;
        ++all;
        kept += std::abs(double(wide.at(p)) - own) < 1e-4 ? 1 : 0;
    });
    CHECK(all > 300);
    CHECK(double(kept) > 0.85 * double(all));  // not beside the axis, where the gradient has a kink
}

TEST_CASE("widenBand: beyond a cut face the last layer goes on, where caps are known they count",
          "[distance][property]") {
    KnownBand known;
    known.field = rod();
    known.domain = known.field.box();  // nothing is known around it: all faces are cuts
    const BrickField wide = widenBand(known, kWide);
    for (int x = 0; x < 40; ++x) {
        CHECK(double(wide.at({x, 19, 19})) == Approx(-8).margin(0.6));
        CHECK(wide.at({x, 15, 8}) == Approx(wide.at({20, 15, 8})).margin(1e-3));
    }
    known.field = closeField(rod(), known.domain, kAllCut, 3.f);  // over 3 voxels more a side
    known.field.translate({3, 3, 3});
    known.domain = {{3, 3, 3}, {42, 42, 42}};
    const BrickField capped = widenBand(known, kWide);
    CHECK(double(capped.at({0, 19, 19})) == Approx(-0.5).margin(0.05));
    CHECK(double(capped.at({39, 19, 19})) == Approx(-0.5).margin(0.05));
    CHECK(double(capped.at({3, 19, 19})) == Approx(-3.5).margin(0.05));
}

TEST_CASE("widenBandCoarse: distances in doubled voxels, also of odd sides", "[distance][oracle]") {
    const KnownBand known = knownOf({43, 41, 44}, 2 * reachToWiden(4.f), ballDistance);
    const BrickField coarse = widenBandCoarse(known, 4.f);
    REQUIRE(coarse.box() == IndexBox::fromSize({22, 21, 22}));
    double worst = 0;
    // The last layer of an odd side has only one voxel's sign.
    forEachVoxel({{0, 0, 0}, {20, 19, 21}}, [&](const Index3& p) {
        const double d = ballDistance({2 * p.x + 0.5, 2 * p.y + 0.5, 2 * p.z + 0.5}) / 2;
        worst = std::max(worst, std::abs(double(coarse.at(p)) - std::clamp(d, -4.0, 4.0)));
    });
    CHECK(worst < 0.1);
}

TEST_CASE("widenBand: without a surface one sign, in a domain of one voxel", "[distance][degenerate]") {
    for (const float value : {-3.f, 3.f}) {
        KnownBand known;
        known.field = BrickField(IndexBox::fromSize({25, 25, 25}), value);
        known.domain = {{12, 12, 12}, {12, 12, 12}};
        const float expected = value < 0 ? -kWide : kWide;
        CHECK(test::samplesOf(widenBand(known, kWide)) == std::vector<float>{expected});
        CHECK(test::samplesOf(widenBandCoarse(known, kWide)) == std::vector<float>{expected});
    }
}

TEST_CASE("widenBand, widenBandCoarse: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const KnownBand known = knownOf({44, 41, 43}, 2 * reachToWiden(4.f), ballDistance);
    const auto wide = [&](const RunContext& ctx) { return widenBand(known, kWide, ctx); };
    const auto coarse = [&](const RunContext& ctx) { return widenBandCoarse(known, 4.f, ctx); };
    CHECK(test::samplesOf(wide(test::onThreads(1))) == test::samplesOf(wide(test::onThreads(4))));
    CHECK(test::samplesOf(coarse(test::onThreads(1))) == test::samplesOf(coarse(test::onThreads(4))));
    CHECK(test::thrownWhenCancelled(wide).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownWhenCancelled(coarse).code == int(ErrorCode::Cancelled));
}
