#include "libvdbsynth/distance/close_band.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/math/lattice.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

BrickField ball() {
    return test::fieldFrom({40, 40, 40}, [](const Index3& p) {
        const double d = length(Vec3d{p.x - 20.0, p.y - 20.0, p.z - 20.0}) - 24;
        return float(std::clamp(d, -8.0, 8.0));
    });
}

// Exact distance to a box.
double boxDistance(const Index3& p, const Vec3d& low, const Vec3d& high) {
    double outside = 0, inside = -1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max(low[axis] - p[axis], p[axis] - high[axis]);
        outside += std::max(d, 0.0) * std::max(d, 0.0);
        inside = std::max(inside, d);
    }
    return outside > 0 ? std::sqrt(outside) : inside;
}

// A bar of radius 1.4 along x, of distances times a slope.
BrickField bar(float slope) {
    return test::fieldFrom({40, 40, 40}, [=](const Index3& p) {
        const double d = std::hypot(p.y - 19.3, p.z - 19.6) - 1.4;
        return float(std::clamp(double(slope) * d, -8.0, 8.0));
    });
}

CloseOptions allCut() {
    CloseOptions options;
    options.cut = kAllCut;
    return options;
}

}  // namespace

TEST_CASE("closedBand: half a space in a box is that half of the box", "[distance][oracle]") {
    const BrickField half = test::fieldFrom({20, 18, 16}, [](const Index3& p) { return float(p.z) - 9.2f; });
    const Index3 corner{-5, 12, 3};
    const BrickField band = closedBand(half, corner, allCut());
    const IndexBox domain{corner, corner + Index3{19, 17, 15}};
    REQUIRE(band.box().contains(domain.expanded(3)));
    const Vec3d low{-5.5, 11.5, 2.5}, high{14.5, 29.5, 12.2};
    double worst = 0, worstFace = 0;
    forEachVoxel(band.box(), [&](const Index3& p) {
        const double d = std::clamp(boxDistance(p, low, high), -3.0, 3.0);
        const double off = std::abs(double(band.at(p)) - d);
        worst = std::max(worst, off);
        // Beside the middle of the faces, far from edges.
        const bool middle = (p.x > 0 && p.x < 9 && p.y > 17 && p.y < 24) ||
                            (p.x > 0 && p.x < 9 && p.z == 7) || (p.y > 17 && p.y < 24 && p.z == 7);
        if (middle) worstFace = std::max(worstFace, off);
    });
    CHECK(worstFace < 1e-3);
    CHECK(worst < 0.6);  // a mesh of the zero level rounds corners off
}

TEST_CASE("closedBand: a ball that fills its box is closed at the box, a valid band, in place",
          "[distance][property]") {
    const BrickField band = closedBand(ball(), {10, -3, 0}, allCut());
    IndexBox solid{{1000, 1000, 1000}, {-1000, -1000, -1000}};
    forEachVoxel(band.box(), [&](const Index3& p) {
        if (band.at(p) >= 0) return;
        for (int axis = 0; axis < 3; ++axis) {
            solid.min[axis] = std::min(solid.min[axis], p[axis]);
            solid.max[axis] = std::max(solid.max[axis], p[axis]);
        }
    });
    CHECK(solid == IndexBox{{10, -3, 0}, {49, 36, 39}});
    CHECK(summarize(zeroLevel(band, band.box(), Facing::Outward)).closedManifold());
}

TEST_CASE("closedBand: a thin bar's distances stay as they are, values that are none are made anew",
          "[distance][oracle]") {
    // A mesh of the bar's zero level is a tenth of a voxel thinner than the bar.
    const BrickField own = bar(1), band = closedBand(own, {0, 0, 0}, allCut());
    std::size_t kept = 0, all = 0;
    forEachVoxel({{8, 0, 0}, {31, 39, 39}}, [&](const Index3& p) {
        if (std::abs(own.at(p)) >= 1) return;
        ++all;
        kept += std::abs(band.at(p) - own.at(p)) < 1e-4f ? 1 : 0;
    });
    CHECK(all > 300);
    CHECK(double(kept) > 0.85 * double(all));  // not beside the axis, where the gradient has a kink
    const BrickField anew = closedBand(bar(0.5f), {0, 0, 0}, allCut());
    for (int x = 8; x < 32; ++x) CHECK(anew.at({x, 19, 23}) - anew.at({x, 19, 22}) == Approx(1).margin(0.05));
}

TEST_CASE("closedBand: faces that are no cut continue, the voxel's size changes roundings only",
          "[distance][property]") {
    CloseOptions options;
    const BrickField open = closedBand(bar(1), {0, 0, 0}, options);
    options.cut[0] = true;  // only the low face of x
    const BrickField band = closedBand(bar(1), {0, 0, 0}, options);
    options.voxelSize = 0.3;
    const BrickField small = closedBand(bar(1), {0, 0, 0}, options);
    CHECK(band.at({0, 19, 20}) == Approx(-0.5).margin(0.05));
    // Outside of all of the box it is capped all the same.
    CHECK(open.at({0, 19, 20}) < -0.1f);
    for (const BrickField& field : {open, band}) {
        CHECK(field.at({-1, 19, 20}) > 0);
        CHECK(field.at({40, 19, 20}) > 0);
    }
    forEachVoxel(band.box(),
                 [&](const Index3& p) { REQUIRE(small.at(p) == Approx(band.at(p)).margin(2e-3)); });
}

TEST_CASE("closedBand: a draft has the same solid and distances of first order", "[distance][property]") {
    CloseOptions options = allCut();
    const BrickField exact = closedBand(ball(), {0, 0, 0}, options);
    options.draft = true;
    const BrickField draft = closedBand(ball(), {0, 0, 0}, options);
    std::size_t near = 0;
    forEachVoxel(draft.box(), [&](const Index3& p) {
        REQUIRE((draft.at(p) < 0) == (exact.at(p) < 0));
        REQUIRE(std::abs(draft.at(p)) <= 3);
        if (std::abs(exact.at(p)) > 0.6f) return;
        ++near;
        REQUIRE(draft.at(p) == Approx(exact.at(p)).margin(0.35));
    });
    CHECK(near > 5000);
}

TEST_CASE("closedBand: one voxel of solid, and none", "[distance][degenerate]") {
    const IndexBox one = IndexBox::fromSize({1, 1, 1});
    for (const bool draft : {false, true}) {
        CloseOptions options = allCut();
        options.draft = draft;
        const BrickField band = closedBand(BrickField(one, -3.f), {2, 2, 2}, options);
        forEachVoxel(band.box(), [&](const Index3& p) {
            REQUIRE((band.at(p) < 0) == (p == Index3{2, 2, 2}));
        });
        const BrickField none = closedBand(BrickField(one, 3.f), {2, 2, 2}, options);
        for (float value : test::samplesOf(none)) REQUIRE(value == 3.f);
    }
}

TEST_CASE("closedBand: same bits for any number of threads, and cancel is heard",
          "[distance][threads][cancel]") {
    const BrickField field = ball();
    for (const bool draft : {false, true}) {
        const auto made = [&](const RunContext& ctx) {
            CloseOptions options = allCut();
            options.draft = draft;
            return closedBand(field, {0, 0, 0}, options, ctx);
        };
        CHECK(test::samplesOf(made(test::onThreads(1))) == test::samplesOf(made(test::onThreads(4))));
        CHECK(test::thrownWhenCancelled(made).code == int(ErrorCode::Cancelled));
    }
}
