#include "libvdbsynth/coordinates/coordinate_level.h"

#include "tests/support/contexts.h"
#include "tests/support/coordinate_levels.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("siteClasses: no two neighbours share a class") {
    for (const test::PointShape& shape : {test::latticePlane(30), test::randomPlane(2000, 30)}) {
        const SurfaceSites sites = sitesOfPoints(shape.point, shape.normal, 8);
        const std::vector<std::uint8_t> classes = siteClasses(sites);
        std::size_t shared = 0;
        for (std::size_t i = 0; i < sites.size(); ++i)
            for (std::size_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
                shared += classes[i] == classes[sites.neighbours[k]];
        CHECK(double(shared) < 0.03 * double(sites.neighbours.size()));
    }
}

TEST_CASE("correctCoordinates: a rigid copy of the sample stays as it is") {
    CoordinateLevel level = test::copiedPlane(40, test::noiseSample(64, 64));
    const std::vector<Vec2f> before = level.coordinate;
    CoordinateOptions options;
    correctCoordinates(level, 2, options);
    for (std::size_t i = 0; i < before.size(); ++i) {
        // At the corners of the plane most taps are guessed.
        const Vec3f& p = level.sites.point[i];
        if (p.x < 1 || p.y < 1 || p.x > 38 || p.y > 38) continue;
        REQUIRE(length(level.coordinate[i] - before[i]) < 1e-4f);
    }
    const CoordinateLevelStats stats = levelStats(level);
    CHECK(stats.coherent > 0.99);
    CHECK(stats.cost < 0.05 * level.samples[0].spread);
}

TEST_CASE("correctCoordinates: a wrong site among right ones is put right") {
    CoordinateLevel level = test::copiedPlane(40, test::noiseSample(64, 64));
    const std::size_t wrong = 20 * 40 + 20;
    const Vec2f right = level.coordinate[wrong];
    level.coordinate[wrong] = {40, 15};
    correctCoordinates(level, 1, {});
    CHECK(length(level.coordinate[wrong] - right) < 1e-4f);
}

TEST_CASE("correctCoordinates: from random coordinates costs fall") {
    CoordinateLevel level = test::planeLevel(50, test::stripesSample(64, 4));
    for (std::size_t i = 0; i < level.sites.size(); ++i)
        level.coordinate.push_back(randomSource(level.samples[0], 7, i, 0));
    const double before = levelStats(level).cost;
    correctCoordinates(level, 4, {});
    CHECK(levelStats(level).cost < 0.5 * before);
    for (const Vec2f& u : level.coordinate) REQUIRE(level.samples[0].isSource(u));
}

TEST_CASE("correctCoordinates: same bits for any number of threads, cancel") {
    CoordinateLevel one = test::planeLevel(50, test::stripesSample(64, 4));
    for (std::size_t i = 0; i < one.sites.size(); ++i)
        one.coordinate.push_back(randomSource(one.samples[0], 7, i, 0));
    CoordinateLevel four = one, stopped = one;
    correctCoordinates(one, 3, {}, test::onThreads(1));
    correctCoordinates(four, 3, {}, test::onThreads(4));
    for (std::size_t i = 0; i < one.coordinate.size(); ++i) {
        REQUIRE(one.coordinate[i].x == four.coordinate[i].x);
        REQUIRE(one.coordinate[i].y == four.coordinate[i].y);
    }
    const auto thrown =
        test::thrownWhenCancelled([&](const RunContext& ctx) { correctCoordinates(stopped, 3, {}, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}

TEST_CASE("randomSource: repeats, differs by site and seed, stays outside the margin") {
    const SampleLevel level = sampleLevel(test::noiseSample(64, 64), 4, 0);
    CHECK(randomSource(level, 1, 2, 3).x == randomSource(level, 1, 2, 3).x);
    CHECK(randomSource(level, 1, 2, 3).x != randomSource(level, 1, 3, 3).x);
    CHECK(randomSource(level, 1, 2, 3).x != randomSource(level, 2, 2, 3).x);
    for (std::uint64_t i = 0; i < 500; ++i) REQUIRE(level.isSource(randomSource(level, 1, i, 0)));
}
