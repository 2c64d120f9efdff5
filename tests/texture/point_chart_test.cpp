#include "libvdbsynth/texture/point_chart.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

namespace {

const double kHalf = std::sqrt(0.5);
const Vec3d kUp{0, 0, 1};

void checkVector(const Vec3d& a, const Vec3d& b) {
    CHECK(length(a - b) < 1e-12);
}

// The seed of a patch in the plane z = 0: x along x, y along y.
ChartSite flatSeed(double x, double y) {
    return {{x, y}, {0, 0, 1}, {1, 0, 0}};
}

ChartEstimate estimateAt(double x, double y, double weight) {
    return {flatSeed(x, y), {0, 1, 0}, weight};
}

}  // namespace

TEST_CASE("continueChart: in the tangent plane it adds the difference and keeps the frame") {
    ChartEstimate e;
    REQUIRE(continueChart(flatSeed(10, 20), {3, 4, 0}, e));
    CHECK(e.site.q.x == Approx(13));
    CHECK(e.site.q.y == Approx(24));
    CHECK(e.weight == Approx(0.2));
    checkVector(e.site.n, {0, 0, 1});
    checkVector(e.site.s, {1, 0, 0});
    checkVector(e.t, {0, 1, 0});
}

TEST_CASE("continueChart: out of the tangent plane it keeps the length and turns the frame") {
    // 45 degrees up along x: the direction is (1, 0), the length stays sqrt(2); normal and s lean back.
    ChartEstimate e;
    REQUIRE(continueChart(flatSeed(0, 0), {1, 0, 1}, e));
    CHECK(e.site.q.x == Approx(std::sqrt(2.0)));
    CHECK(e.site.q.y == Approx(0).margin(1e-12));
    checkVector(e.site.n, {-kHalf, 0, kHalf});
    checkVector(e.site.s, {kHalf, 0, kHalf});
    checkVector(e.t, {0, 1, 0});
    // The same along a diagonal: v = (1, 1, 1), c = (1, 1) / sqrt(2).
    REQUIRE(continueChart(flatSeed(0, 0), {1, 1, 1}, e));
    CHECK(e.site.q.x == Approx(std::sqrt(1.5)));
    CHECK(e.site.q.y == Approx(std::sqrt(1.5)));
    CHECK(length(e.site.s) == Approx(1));
    CHECK(length(e.t) == Approx(1));
    CHECK(dot(e.site.s, e.t) == Approx(0).margin(1e-12));
    CHECK(dot(e.site.n, Vec3d{1, 1, 1}) == Approx(0).margin(1e-12));
}

TEST_CASE("continueChart: nothing follows along the normal") {
    ChartEstimate e;
    CHECK_FALSE(continueChart(flatSeed(0, 0), {0, 0, 2}, e));
    CHECK_FALSE(continueChart(flatSeed(0, 0), {1e-4, 0, -1}, e));
    CHECK(continueChart(flatSeed(0, 0), {2e-3, 0, 1}, e));
}

TEST_CASE("meanSite: weighted positions, and a frame on the surface") {
    ChartEstimate two[2] = {estimateAt(0, 0, 3), estimateAt(4, 8, 1)};
    two[1].site.n = {0, kHalf, kHalf};
    two[1].site.s = {kHalf, kHalf, -kHalf};
    const ChartSite mean = meanSite(two, 2, kUp);
    CHECK(mean.q.x == Approx(1));
    CHECK(mean.q.y == Approx(2));
    checkVector(mean.n, kUp);
    checkVector(mean.s, normalized(Vec3d{3 + kHalf, kHalf, 0}));
    CHECK(meanSite(two, 1, kUp).q.x == 0);
}

TEST_CASE("meanSite: estimates that cancel leave the nearest one's direction") {
    ChartEstimate two[2] = {estimateAt(0, 0, 1), estimateAt(0, 0, 1)};
    two[1].site.s = {-1, 0, 0};
    checkVector(meanSite(two, 2, kUp).s, {1, 0, 0});
    two[0].site.s = two[1].site.s = {0, 0, 1};  // along the normal
    const Vec3d any = meanSite(two, 2, kUp).s;
    CHECK(length(any) == Approx(1));
    CHECK(any.z == 0);
}

TEST_CASE("chartDistortion: by hand") {
    // Positions 1 and 3 on x with weights 1 and 1: mean 2; mean of w |q_l - q| = 1, maximum 1.
    ChartEstimate two[2] = {estimateAt(1, 0, 1), estimateAt(3, 0, 1)};
    ChartDistortion weights;
    CHECK(chartDistortion(two, 2, meanSite(two, 2, kUp), weights) == Approx(2 * (1 + 1)));
    weights.w1 = 0.5;
    CHECK(chartDistortion(two, 2, meanSite(two, 2, kUp), weights) == Approx(2 * (0.5 + 1)));
    // Weights 2 and 1, mean 5/3: terms 2 * 2/3 and 1 * 4/3; sum over weights 8/9, maximum 4/3.
    two[0].weight = 2;
    CHECK(chartDistortion(two, 2, meanSite(two, 2, kUp), {}) == Approx(2 * (8.0 / 9 + 4.0 / 3)));
    // Frames turned by +-60 degrees about the normal: 2 - 1/2 - 1/2 = 1 each, weight 2.
    const double c = 0.5, s = std::sqrt(0.75);
    two[0] = two[1] = estimateAt(0, 0, 2);
    two[0].site.s = {c, s, 0};
    two[0].t = {-s, c, 0};
    two[1].site.s = {c, -s, 0};
    two[1].t = {s, c, 0};
    weights = {};
    weights.w2 = 3;
    CHECK(chartDistortion(two, 2, meanSite(two, 2, kUp), weights) == Approx(3 * (3 * 1 + 2)));
    CHECK(chartDistortion(two, 1, meanSite(two, 1, kUp), weights) == Approx(0).margin(1e-12));
}
