#include "libvdbsynth/relief/growth/grown_relief.h"

#include "tests/support/contexts.h"
#include "tests/support/relief_shapes.h"
#include "tests/support/said.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace vdbsynth;

namespace {

constexpr int kSide = 36;

struct Case {
    test::SineRelief sine;
    ReliefSites sample = test::sineSample(sine, kSide);
    ReliefDistance distance = test::sineDistance(sine, kSide);
};

GrownReliefOptions options(double neighbourhood = 6) {
    GrownReliefOptions o;
    o.neighbourhood = neighbourhood;
    return o;
}

// Root mean square difference of height between a site and its nearest.
double stepRms(const SurfaceSites& sites, const std::vector<Vec3f>& displacement) {
    double sum = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const std::uint32_t j = sites.neighbours[sites.begin[i]];
        const double d =
            double(dot(displacement[i], sites.normal[i]) - dot(displacement[j], sites.normal[j]));
        sum += d * d;
    }
    return std::sqrt(sum / double(sites.size()));
}

double heightRms(const SurfaceSites& sites, const std::vector<Vec3f>& displacement) {
    double sum = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const double h = double(dot(displacement[i], sites.normal[i]));
        sum += h * h;
    }
    return std::sqrt(sum / double(sites.size()));
}

// What one sine along `direction` leaves of the heights, its phase fitted: root mean square.
double awayFromSine(const test::SineRelief& sine, const SurfaceSites& sites, const Vec3f& direction,
                    const std::vector<Vec3f>& displacement) {
    double least = 1e9;
    for (double phase = 0; phase < sine.wavelength; phase += 0.05) {
        double sum = 0;
        for (std::size_t i = 0; i < sites.size(); ++i) {
            const double d =
                double(displacement[i].z) - sine.height(double(dot(sites.point[i], direction)) + phase);
            sum += d * d;
        }
        least = std::min(least, sum);
    }
    return std::sqrt(least / double(sites.size()));
}

}  // namespace

TEST_CASE("growRelief: a sine on a plane continues, along the target's own directions") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(1600, 40));
    const Vec3f along{std::sqrt(0.75f), 0.5f, 0};
    const GrownRelief grown =
        growRelief(c.sample, c.distance, target, std::vector<Vec3f>(target.size(), along), options());
    const auto best = [&](const SurfaceSites& t, const std::vector<Vec3f>& d, const GrownRelief& g) {
        return bestMismatch({t, d, g.displacement}, c.sample, c.distance, reliefNeighbourhoods(t, 6, 0.5))
            .mean;
    };
    const double rms = c.sine.amplitude / std::sqrt(2.0);
    const double away = awayFromSine(c.sine, target, along, grown.displacement);
    INFO("away " << away << " of " << rms << ", grown " << std::sqrt(grown.grownMean) << " mismatch "
                 << std::sqrt(grown.mismatch.mean) << " outside " << grown.mismatch.outside << " best "
                 << std::sqrt(best(target, std::vector<Vec3f>(target.size(), along), grown)));
    CHECK(away < 0.1 * rms);
    CHECK(heightRms(target, grown.displacement) == Approx(rms).epsilon(0.1));
    CHECK(std::sqrt(grown.grownMean) < 0.1);
    CHECK(std::sqrt(grown.mismatch.mean) < 0.12);
    CHECK(grown.mismatch.outside < 0.1);
    // Differences between neighbours as in the sample at the same distance: the sine's slope times it.
    std::vector<Vec3f> exact;
    for (const Vec3f& p : target.point) exact.push_back({0, 0, float(c.sine.height(double(dot(p, along))))});
    CHECK(stepRms(target, grown.displacement) == Approx(stepRms(target, exact)).epsilon(0.1));
    for (const Vec3f& d : grown.displacement) REQUIRE(std::abs(d.x) + std::abs(d.y) < 1e-5f);
}

TEST_CASE("growRelief: a sine on a ball, whose curvature is small beside the relief") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::spiralSphere(4000, 24));
    const std::vector<Vec3f> around(target.size(), {0, 0, 1});
    const GrownRelief grown = growRelief(c.sample, c.distance, target, around, options(4));
    const auto best = [&](const SurfaceSites& t, const std::vector<Vec3f>& d, const GrownRelief& g) {
        return bestMismatch({t, d, g.displacement}, c.sample, c.distance, reliefNeighbourhoods(t, 4, 0.5))
            .mean;
    };
    const double rms = c.sine.amplitude / std::sqrt(2.0);
    INFO("rms " << heightRms(target, grown.displacement) << " grown " << std::sqrt(grown.grownMean)
                << " mismatch " << std::sqrt(grown.mismatch.mean) << " outside " << grown.mismatch.outside
                << " best " << std::sqrt(best(target, around, grown)));
    CHECK(heightRms(target, grown.displacement) == Approx(rms).epsilon(0.1));
    CHECK(std::sqrt(grown.grownMean) < 0.2);
    CHECK(std::sqrt(grown.mismatch.mean) < 0.3);
    for (std::size_t i = 0; i < target.size(); ++i)  // along the normals
        REQUIRE(std::abs(double(dot(grown.displacement[i], target.normal[i]))) ==
                Approx(double(length(grown.displacement[i]))).margin(1e-5));
}

TEST_CASE("growRelief: overhanging displacements keep their direction in the frame") {
    Case c;
    for (Vec3f& d : c.sample.displacement) d = {0.5f, 0, d.z};
    const SurfaceSites target = test::sitesOf(test::randomPlane(300, 16));
    const GrownRelief grown =
        growRelief(c.sample, c.distance, target, std::vector<Vec3f>(target.size(), {0, 1, 0}), options(4));
    for (const Vec3f& d : grown.displacement) {
        REQUIRE(d.x == Approx(0).margin(1e-6));
        REQUIRE(d.y == Approx(0.5));
    }
}

TEST_CASE("growRelief: the order is a permutation that begins at the seed, sources are sites") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(500, 20));
    GrownReliefOptions o = options(4);
    o.targetSite = 123;
    o.seedSite = 600;
    const GrownRelief grown = growRelief(c.sample, c.distance, target, std::vector<Vec3f>(500, {1, 0, 0}), o);
    CHECK(grown.order[123] == 0);
    CHECK(grown.source[123] == 600);
    std::set<std::uint32_t> order(grown.order.begin(), grown.order.end());
    CHECK(order.size() == 500);
    CHECK(*order.rbegin() == 499);
    for (std::uint32_t s : grown.source) REQUIRE(s < c.sample.sites.size());
}

TEST_CASE("growRelief: seeds vary it, the same seed does not, nor do threads") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(500, 20));
    const std::vector<Vec3f> tangent(500, {1, 0, 0});
    GrownReliefOptions o = options(4);
    o.top = 1;
    const auto sources = [&](std::uint64_t seed, int threads) {
        RunContext ctx;
        ctx.seed = seed;
        ctx.threads = threads;
        return growRelief(c.sample, c.distance, target, tangent, o, ctx).source;
    };
    const auto one = sources(7, 1);
    CHECK(one == sources(7, 4));
    CHECK(one != sources(8, 1));
    o.top = 0;
    CHECK(sources(7, 1) == sources(8, 1));
    o.seedSite = kRandomSeed;
    CHECK(sources(7, 1) != sources(8, 1));
}

TEST_CASE("growRelief: the neighbourhood's size and the defaults are said") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(300, 16));
    test::Said said;
    const GrownRelief grown =
        growRelief(c.sample, c.distance, target, std::vector<Vec3f>(300, {1, 0, 0}), {}, said.ctx);
    CHECK(grown.neighbourhood == Approx(4 * meanSpacing(target)));
    CHECK(said.noted("`neighbourhood` is not given"));
    CHECK(said.warnings.empty());
}

TEST_CASE("growRelief: one site, coinciding sites, two parts") {
    const Case c;
    const SurfaceSites single = sitesOfPoints({{0, 0, 0}}, {{0, 0, 1}}, 8);
    const GrownRelief one = growRelief(c.sample, c.distance, single, {{1, 0, 0}}, options());
    CHECK(one.source.size() == 1);
    CHECK(one.mismatch.sites == 0);
    // A sample of one site: everything comes from it.
    const ReliefSites point{single, {{1, 0, 0}}, {{0, 0, 2}}};
    const SurfaceSites target = test::sitesOf(test::randomPlane(50, 8));
    const GrownRelief copied =
        growRelief(point, c.distance, target, std::vector<Vec3f>(50, {1, 0, 0}), options(2));
    for (const Vec3f& d : copied.displacement) REQUIRE(d.z == 2);

    const SurfaceSites same =
        sitesOfPoints(std::vector<Vec3f>(3, {1, 1, 1}), std::vector<Vec3f>(3, {0, 0, 1}), 8);
    test::Said said;
    CHECK(growRelief(c.sample, c.distance, same, std::vector<Vec3f>(3, {1, 0, 0}), {}, said.ctx).seeds == 3);
    CHECK(said.warned("3 parts"));
    test::PointShape two = test::randomPlane(200, 12);
    for (std::size_t i = 0; i < 200; ++i) {
        two.point.push_back(two.point[i] + Vec3f{100, 0, 0});
        two.normal.push_back({0, 0, 1});
    }
    test::Said parts;
    const GrownRelief both = growRelief(c.sample, c.distance, test::sitesOf(two),
                                        std::vector<Vec3f>(400, {1, 0, 0}), options(3), parts.ctx);
    CHECK(both.seeds == 2);
    CHECK(parts.noted("2 parts"));
    CHECK(parts.warnings.empty());
}

TEST_CASE("growRelief: a sample without relief, and a target smaller than the neighbourhood, are said") {
    Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(60, 6));
    const std::vector<Vec3f> tangent(60, {1, 0, 0});
    test::Said small;
    const GrownRelief patch = growRelief(c.sample, c.distance, target, tangent, options(20), small.ctx);
    CHECK(small.noted("larger than the target"));
    CHECK(stepRms(target, patch.displacement) < 1);
    for (Vec3f& d : c.sample.displacement) d = {};
    test::Said flat;
    const GrownRelief none = growRelief(c.sample, c.distance, target, tangent, options(2), flat.ctx);
    CHECK(flat.warned("no relief"));
    CHECK(heightRms(target, none.displacement) == 0);
}

TEST_CASE("growRelief: a band under the relief's amplitude is said") {
    const Case c;
    const ReliefDistance narrow = test::sineDistance({1.5, 5}, kSide, 6, 0.25f);
    const SurfaceSites target = test::sitesOf(test::randomPlane(200, 14));
    test::Said said;
    growRelief(c.sample, narrow, target, std::vector<Vec3f>(200, {1, 0, 0}), options(4), said.ctx);
    CHECK(said.warned("outside the sample's band"));
}

TEST_CASE("growRelief: every error, cancel") {
    const Case c;
    const SurfaceSites target = test::sitesOf(test::randomPlane(60, 6));
    const std::vector<Vec3f> tangent(60, {1, 0, 0});
    const auto codeOf = [&](auto change) {
        GrownReliefOptions o = options(2);
        change(o);
        return test::thrownBy([&] { growRelief(c.sample, c.distance, target, tangent, o); }).code;
    };
    const int invalid = int(ErrorCode::InvalidOption);
    CHECK(codeOf([](auto& o) { o.neighbourhood = -1; }) == invalid);
    CHECK(codeOf([](auto& o) { o.neighbourhood = NAN; }) == invalid);
    CHECK(codeOf([](auto& o) { o.weightFalloff = 0; }) == invalid);
    CHECK(codeOf([](auto& o) { o.top = 101; }) == invalid);
    CHECK(codeOf([](auto& o) { o.seedRadius = -1; }) == invalid);
    CHECK(codeOf([](auto& o) { o.seedSite = -3; }) == invalid);
    CHECK(codeOf([](auto& o) { o.seedSite = kSide * kSide; }) == invalid);
    CHECK(codeOf([](auto& o) { o.targetSite = -2; }) == invalid);
    CHECK(codeOf([](auto& o) { o.targetSite = 60; }) == invalid);
    CHECK(test::thrownBy([&] { growRelief({}, c.distance, target, tangent); }).code ==
          int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { growRelief(c.sample, c.distance, {}, {}); }).code ==
          int(ErrorCode::EmptyInput));
    CHECK(test::thrownBy([&] { growRelief(c.sample, c.distance, target, {}); }).code ==
          int(ErrorCode::ShapeMismatch));
    // In the middle of growth.
    std::atomic<bool> cancel{false};
    RunContext stopped;
    stopped.cancel = &cancel;
    std::size_t reports = 0;
    stopped.onProgress = [&](const Progress& progress) {
        ++reports;
        if (progress.done > 40) cancel = true;
    };
    CHECK(test::thrownBy([&] {
              growRelief(c.sample, c.distance, target, tangent, options(1), stopped);
          }).code == int(ErrorCode::Cancelled));
    CHECK(reports > 3);
    CHECK(test::thrownWhenCancelled([&](const RunContext& ctx) {
              growRelief(c.sample, c.distance, target, tangent, options(2), ctx);
          }).code == int(ErrorCode::Cancelled));
}
