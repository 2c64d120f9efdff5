#include "libvdbsynth/relief/transfer/relief_charts.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_tangents.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>

using namespace vdbsynth;

namespace {

struct Laid {
    SurfaceSites sites;
    std::vector<Vec3f> tangent;
    std::vector<ReliefChart> charts;
};

Laid laid(const test::PointShape& shape, double spacing, const ReliefChartOptions& options = {}) {
    Laid out;
    out.sites = sitesOfPoints(shape.point, shape.normal, 8);
    out.tangent = siteTangents(out.sites, std::vector<Vec3f>(shape.point.size(), Vec3f{1, 0, 0}), spacing);
    out.charts = layReliefCharts(out.sites, out.tangent, spacing, options);
    return out;
}

}  // namespace

TEST_CASE("layReliefCharts: a plane is one chart, moved rigidly") {
    const Laid plane = laid(test::randomPlane(2000, 45), 1);
    REQUIRE(plane.charts.size() == 1);
    const ReliefChart& chart = plane.charts[0];
    CHECK(chart.site.size() == 2000);
    const Vec3f& first = plane.sites.point[chart.site[0]];
    for (std::size_t k = 0; k < chart.site.size(); ++k) {
        const Vec3f off = plane.sites.point[chart.site[k]] - first;
        REQUIRE(length(chart.at[k] - Vec2f{off.x, off.y}) < 1e-3f);
    }
}

TEST_CASE("layReliefCharts: a ball takes several, in which steps keep their lengths, and is covered") {
    ReliefChartOptions options;
    options.overlap = 3;
    const Laid ball = laid(test::spiralSphere(8000, 25), 1, options);
    CHECK(ball.charts.size() >= 4);
    CHECK(ball.charts.size() <= 60);
    std::vector<int> shown(ball.sites.size(), 0);
    std::vector<Vec2f> at(ball.sites.size());
    double error = 0;
    std::size_t steps = 0;
    for (const ReliefChart& chart : ball.charts) {
        std::vector<char> in(ball.sites.size(), 0);
        for (std::size_t k = 0; k < chart.site.size(); ++k) {
            at[chart.site[k]] = chart.at[k];
            in[chart.site[k]] = 1;
            ++shown[chart.site[k]];
        }
        for (std::uint32_t i : chart.site)
            for (std::size_t k = ball.sites.begin[i]; k < ball.sites.begin[i + 1]; ++k) {
                const std::uint32_t j = ball.sites.neighbours[k];
                if (!in[j]) continue;
                const double flat = double(length(at[j] - at[i])),
                             real = double(length(ball.sites.point[j] - ball.sites.point[i]));
                error += std::abs(flat / real - 1);
                ++steps;
            }
    }
    CHECK(error / double(steps) < 0.05);
    CHECK(std::count(shown.begin(), shown.end(), 0) <= 400);  // ReliefChartOptions::covered
    CHECK(std::count_if(shown.begin(), shown.end(), [](int n) { return n > 1; }) > 400);
}

TEST_CASE("layReliefCharts: charts stay within the largest rotation from the tangents") {
    test::PointShape plane = test::latticePlane(40);
    const SurfaceSites sites = sitesOfPoints(plane.point, plane.normal, 8);
    std::vector<Vec3f> tangent;
    for (const Vec3f& p : plane.point) {  // a quarter turn over the plane
        const double angle = double(p.x) / 39 * kPi / 2;
        tangent.push_back({float(cosine(angle)), float(sine(angle)), 0});
    }
    ReliefChartOptions options;
    options.maxRotation = 8;
    options.fewest = 10;
    const std::vector<ReliefChart> charts = layReliefCharts(sites, tangent, 1, options);
    CHECK(charts.size() >= 5);
    for (const ReliefChart& chart : charts) {
        float low = 100, high = -100;
        for (std::uint32_t i : chart.site) {
            low = std::min(low, plane.point[i].x);
            high = std::max(high, plane.point[i].x);
        }
        CHECK(high - low <= 2 * 8 / (90.0f / 39) + 1);
    }
}

TEST_CASE("layReliefCharts: one site, parts, every error") {
    const Laid one = laid({{{1, 2, 3}}, {{0, 0, 1}}}, 1);
    REQUIRE(one.charts.size() == 1);
    CHECK(one.charts[0].site == std::vector<std::uint32_t>{0});

    test::PointShape two = test::latticePlane(10), other = test::latticePlane(10);
    for (Vec3f& p : other.point) two.point.push_back(p + Vec3f{1000, 0, 0});
    two.normal.resize(200, {0, 0, 1});
    CHECK(laid(two, 1).charts.size() == 2);

    const SurfaceSites sites = sitesOfPoints({{0, 0, 0}}, {{0, 0, 1}}, 8);
    const std::vector<Vec3f> x{{1, 0, 0}};
    CHECK_THROWS_AS(layReliefCharts({}, {}, 1), Error);
    CHECK_THROWS_AS(layReliefCharts(sites, {}, 1), Error);
    CHECK_THROWS_AS(layReliefCharts(sites, x, 0), Error);
    for (const auto& change : std::vector<std::function<void(ReliefChartOptions&)>>{
             [](auto& o) { o.differs = 2; }, [](auto& o) { o.maxRotation = 181; },
             [](auto& o) { o.overlap = -1; }, [](auto& o) { o.covered = 1.1; },
             [](auto& o) { o.most = 0; }}) {
        ReliefChartOptions options;
        change(options);
        CHECK_THROWS_AS(layReliefCharts(sites, x, 1, options), Error);
    }
}
