#include "libvdbsynth/coordinates/coordinate_synthesis.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"
#include "tests/support/sample_images.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vdbsynth;

namespace {

CoordinateSites sitesOf(const test::PointShape& shape, const Vec3f& direction) {
    CoordinateSites sites{sitesOfPoints(shape.point, shape.normal, kSiteNeighbours), {}, {}};
    for (const Vec3f& n : shape.normal) sites.tangent.push_back(tangentNear(n, direction));
    return sites;
}

// Of the pairs of sites one step apart along an axis the share whose values differ by more than a half.
double changesAlong(const CoordinateSites& sites, const CoordinateResult& result, const SampleImage& sample,
                    int axis, int side) {
    std::size_t changes = 0, pairs = 0;
    for (std::size_t i = 0; i < sites.sites.point.size(); ++i) {
        const std::size_t j = i + (axis == 0 ? 1 : std::size_t(side));
        if (j >= sites.sites.point.size() || (axis == 0 && (i + 1) % std::size_t(side) == 0)) continue;
        ++pairs;
        changes += std::abs(nearestTexel(sample, result.coordinate[i])[0] -
                            nearestTexel(sample, result.coordinate[j])[0]) > 0.5f;
    }
    return double(changes) / double(pairs);
}

}  // namespace

TEST_CASE("synthesizeCoordinates: stripes stay stripes, along the frames") {
    const SampleImage stripes = test::stripesSample(64, 4);
    for (const Vec3f& u : {Vec3f{1, 0, 0}, Vec3f{0, 1, 0}}) {
        const CoordinateSites sites = sitesOf(test::latticePlane(80), u);
        const CoordinateResult result = synthesizeCoordinates(sites, {stripes}, 1);
        const int across = u.x > 0 ? 0 : 1;
        // A change every four sites across the stripes, nearly none along them.
        CHECK(changesAlong(sites, result, stripes, across, 80) == Approx(0.25).margin(0.03));
        CHECK(changesAlong(sites, result, stripes, 1 - across, 80) < 0.03);
    }
}

TEST_CASE("synthesizeCoordinates: a texel twice as large makes stripes twice as wide") {
    const SampleImage stripes = test::stripesSample(64, 4);
    const CoordinateSites sites = sitesOf(test::latticePlane(80), {1, 0, 0});
    const CoordinateResult result = synthesizeCoordinates(sites, {stripes}, 2);
    CHECK(changesAlong(sites, result, stripes, 0, 80) == Approx(0.125).margin(0.02));
    REQUIRE(!result.levels.empty());
    CHECK(result.levels.back().sites < 6400);  // the points themselves are denser than the texels
}

TEST_CASE("synthesizeCoordinates: what is used of the sample has its histogram") {
    const SampleImage noise = test::noiseSample(64, 64);
    const CoordinateSites sites = sitesOf(test::spiralSphere(20000, 40), {0, 0, 1});
    const CoordinateResult result = synthesizeCoordinates(sites, {noise}, 0.9);
    double sum = 0, squares = 0;
    for (const Vec2f& u : result.coordinate) {
        const double value = double(nearestTexel(noise, u)[0]);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / 20000;
    CHECK(mean == Approx(0.5).margin(0.02));
    CHECK(std::sqrt(squares / 20000 - mean * mean) == Approx(0.2887).margin(0.012));
}

TEST_CASE("synthesizeCoordinates: labels choose the sample") {
    SampleImage dark = test::noiseSample(32, 32), light = test::noiseSample(48, 40, 2);
    CoordinateSites sites = sitesOf(test::latticePlane(60), {1, 0, 0});
    for (const Vec3f& p : sites.sites.point) sites.label.push_back(p.x < 30 ? 0 : 1);
    const CoordinateResult result = synthesizeCoordinates(sites, {dark, light}, 1);
    for (std::size_t i = 0; i < sites.sites.point.size(); ++i) {
        const Vec2f& u = result.coordinate[i];
        REQUIRE(u.x >= 0);
        REQUIRE(u.x <= (sites.label[i] == 0 ? 32 : 48));
        REQUIRE(u.y <= (sites.label[i] == 0 ? 32 : 40));
    }
}

TEST_CASE("synthesizeCoordinates: same bits for any number of threads, other coordinates by another seed") {
    const SampleImage noise = test::noiseSample(40, 40);
    const CoordinateSites sites = sitesOf(test::randomPlane(6000, 70), {1, 0, 0});
    const auto run = [&](int threads, std::uint64_t seed) {
        RunContext ctx = test::onThreads(threads);
        ctx.seed = seed;
        return synthesizeCoordinates(sites, {noise}, 1, {}, ctx);
    };
    const CoordinateResult one = run(1, 0), four = run(4, 0), other = run(1, 1);
    std::size_t differs = 0;
    for (std::size_t i = 0; i < one.coordinate.size(); ++i) {
        REQUIRE(one.coordinate[i].x == four.coordinate[i].x);
        REQUIRE(one.coordinate[i].y == four.coordinate[i].y);
        differs += one.coordinate[i].x != other.coordinate[i].x;
    }
    CHECK(differs > 3000);
}

TEST_CASE("synthesizeCoordinates: charts are rotated from the tangents no farther than allowed") {
    const CoordinateSites sites = sitesOf(test::spiralSphere(8000, 20), {0, 0, 1});
    for (double degrees : {0.0, 10.0, 60.0}) {
        CoordinateOptions options;
        options.maxRotation = degrees;
        const CoordinateResult result =
            synthesizeCoordinates(sites, {test::noiseSample(64, 64)}, 0.7, options);
        double most = 1;
        for (std::size_t i = 0; i < sites.tangent.size(); ++i) {
            most = std::min(most, double(dot(result.tangent[i], sites.tangent[i])));
            REQUIRE(std::abs(dot(result.tangent[i], sites.sites.normal[i])) < 1e-3f);
            REQUIRE(length(result.tangent[i]) == Approx(1).margin(1e-4));
        }
        CHECK(most >= std::cos(degrees * 3.14159265 / 180) - 1e-3);
    }
}

TEST_CASE("synthesizeCoordinates: degenerate sites and samples") {
    const SampleImage noise = test::noiseSample(16, 16), texel{1, 1, 3, false, {1, 0, 0}};
    CHECK(synthesizeCoordinates({}, {noise}, 1).coordinate.empty());
    for (std::size_t count : {1, 2, 3}) {
        CoordinateSites sites = sitesOf(test::randomPlane(count, 5), {1, 0, 0});
        CHECK(synthesizeCoordinates(sites, {noise}, 1).coordinate.size() == count);
        CHECK(synthesizeCoordinates(sites, {texel}, 1).coordinate.size() == count);
    }
    // All at one place, and on a line.
    CoordinateSites same = sitesOf(test::randomPlane(100, 0), {1, 0, 0});
    CHECK(synthesizeCoordinates(same, {noise}, 1).coordinate.size() == 100);
    test::PointShape row = test::latticePlane(20);
    for (Vec3f& p : row.point) p = {p.x + 20 * p.y, 0, 0};
    const CoordinateSites line = sitesOf(row, {1, 0, 0});
    CHECK(synthesizeCoordinates(line, {noise}, 1).coordinate.size() == 400);
}

TEST_CASE("synthesizeCoordinates: every refusal") {
    const SampleImage noise = test::noiseSample(16, 16);
    const CoordinateSites sites = sitesOf(test::latticePlane(4), {1, 0, 0});
    const auto code = [&](const CoordinateSites& s, const std::vector<SampleImage>& samples, double texel,
                          const CoordinateOptions& options = {}) {
        return test::thrownBy([&] { synthesizeCoordinates(s, samples, texel, options); }).code;
    };
    CHECK(code(sites, {noise}, 0) == int(ErrorCode::InvalidOption));
    CHECK(code(sites, {}, 1) == int(ErrorCode::EmptyInput));
    CHECK(code(sites, {SampleImage{}}, 1) == int(ErrorCode::EmptyInput));
    CHECK(code(sites, {noise, {1, 1, 3, false, {1, 0, 0}}}, 1) == int(ErrorCode::ShapeMismatch));
    CoordinateSites bad = sites;
    bad.tangent.pop_back();
    CHECK(code(bad, {noise}, 1) == int(ErrorCode::ShapeMismatch));
    bad = sites;
    bad.label.assign(16, 1);
    CHECK(code(bad, {noise}, 1) == int(ErrorCode::ShapeMismatch));
    CoordinateOptions options;
    options.passes = 21;
    CHECK(code(sites, {noise}, 1, options) == int(ErrorCode::InvalidOption));
    for (double CoordinateOptions::*field : {&CoordinateOptions::maxRotation, &CoordinateOptions::coherence,
                                             &CoordinateOptions::uniformity, &CoordinateOptions::histogram}) {
        options = {};
        options.*field = -1;
        CHECK(code(sites, {noise}, 1, options) == int(ErrorCode::InvalidOption));
    }
    for (int CoordinateOptions::*field :
         {&CoordinateOptions::coarsePasses, &CoordinateOptions::similar, &CoordinateOptions::levels}) {
        options = {};
        options.*field = -1;
        CHECK(code(sites, {noise}, 1, options) == int(ErrorCode::InvalidOption));
    }
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { synthesizeCoordinates(sites, {noise}, 1, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}

TEST_CASE("synthesizeCoordinates: takes nothing from texels that are not valid") {
    SampleImage image = test::noiseSample(64, 64);
    image.valid.assign(image.texels(), 0);
    const auto valid = [](int x, int y) { return x >= 8 && x < 40 && y >= 20 && y < 60; };
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) image.valid[std::size_t(y * 64 + x)] = valid(x, y);
    const test::PointShape plane = test::latticePlane(60);
    CoordinateSites sites;
    sites.sites = sitesOfPoints(plane.point, plane.normal, kSiteNeighbours);
    sites.tangent.assign(plane.point.size(), {1, 0, 0});
    const CoordinateResult result = synthesizeCoordinates(sites, {image}, 1);
    for (const Vec2f& u : result.coordinate) REQUIRE(valid(int(u.x), int(u.y)));

    image.valid.resize(10);
    CHECK_THROWS_AS(synthesizeCoordinates(sites, {image}, 1), Error);
}
