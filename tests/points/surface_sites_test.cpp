#include "libvdbsynth/points/surface_sites.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace vdbsynth;

namespace {

// The oracle: by a linear scan.
std::vector<std::uint32_t> nearestByScan(const SurfaceSites& sites, std::size_t i, std::size_t count) {
    std::vector<std::pair<float, std::uint32_t>> all;
    for (std::uint32_t j = 0; j < sites.size(); ++j) {
        const Vec3f v = sites.point[j] - sites.point[i];
        if (dot(v, v) > 0 && dot(sites.normal[i], sites.normal[j]) > 0) all.push_back({dot(v, v), j});
    }
    std::sort(all.begin(), all.end());
    std::vector<std::uint32_t> numbers;
    for (std::size_t k = 0; k < std::min(count, all.size()); ++k) numbers.push_back(all[k].second);
    return numbers;
}

void checkAgainstScan(const test::PointShape& shape, std::size_t count, std::size_t step) {
    const SurfaceSites sites = sitesOfPoints(shape.point, shape.normal, count);
    REQUIRE(sites.begin.size() == sites.size() + 1);
    for (std::size_t i = 0; i < sites.size(); i += step) {
        const std::vector<std::uint32_t> found(sites.neighbours.begin() + sites.begin[i],
                                               sites.neighbours.begin() + sites.begin[i + 1]);
        REQUIRE(found == nearestByScan(sites, i, count));
    }
}

}  // namespace

TEST_CASE("sitesOfPoints: three points on a line by hand") {
    const std::vector<Vec3f> up(3, {0, 0, 1});
    const SurfaceSites sites = sitesOfPoints({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}}, up, 2);
    CHECK(sites.begin == std::vector<std::uint32_t>{0, 2, 4, 6});
    CHECK(sites.neighbours == std::vector<std::uint32_t>{1, 2, 0, 2, 1, 0});
    CHECK(meanNearestDistance(sites) == Approx((1 + 1 + 2) / 3.0));
}

TEST_CASE("sitesOfPoints: the same as a linear scan, on a plane, a ball and in a clump") {
    checkAgainstScan(test::randomPlane(3000, 10), 8, 7);
    checkAgainstScan(test::randomPlane(3000, 10), 25, 13);
    checkAgainstScan(test::latticePlane(40), 9, 11);
    checkAgainstScan(test::spiralSphere(4000, 3), 25, 17);
    test::PointShape uneven = test::randomPlane(1500, 1e-3);  // crowded in one cell of the whole
    const test::PointShape wide = test::randomPlane(500, 10, 2);
    uneven.point.insert(uneven.point.end(), wide.point.begin(), wide.point.end());
    uneven.normal.insert(uneven.normal.end(), wide.normal.begin(), wide.normal.end());
    checkAgainstScan(uneven, 12, 19);
}

TEST_CASE("sitesOfPoints: the other side of a thin wall is no neighbour") {
    test::PointShape wall = test::latticePlane(20);
    const std::size_t half = wall.point.size();
    for (std::size_t i = 0; i < half; ++i) {
        wall.point.push_back(wall.point[i] + Vec3f{0, 0, -0.1f});
        wall.normal.push_back({0, 0, -1});
    }
    const SurfaceSites sites = sitesOfPoints(wall.point, wall.normal, 8);
    for (std::size_t i = 0; i < sites.size(); ++i) {
        REQUIRE(sites.degree(i) == 8);
        for (std::size_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
            REQUIRE((sites.neighbours[k] < half) == (i < half));
    }
}

TEST_CASE("sitesOfPoints: degenerate sets") {
    CHECK(sitesOfPoints({}, {}, 8).size() == 0);
    CHECK(sitesOfPoints({{1, 2, 3}}, {{0, 0, 1}}, 8).neighbours.empty());
    // Coinciding points are no neighbours of each other.
    const std::vector<Vec3f> up(300, {0, 0, 1});
    CHECK(sitesOfPoints(std::vector<Vec3f>(300, {1, 1, 1}), up, 8).neighbours.empty());
    CHECK(meanNearestDistance(sitesOfPoints(std::vector<Vec3f>(300, {1, 1, 1}), up, 8)) == 0);
    // One far outlier.
    test::PointShape shape = test::randomPlane(500, 1);
    shape.point.push_back({1e6f, 1e6f, 0});
    shape.normal.push_back({0, 0, 1});
    checkAgainstScan(shape, 6, 5);
}

TEST_CASE("sitesOfPoints: bad arguments, cancel, threads") {
    CHECK_THROWS_AS(sitesOfPoints({{0, 0, 0}}, {}, 8), Error);
    CHECK_THROWS_AS(sitesOfPoints({}, {}, 0), Error);
    CHECK_THROWS_AS(sitesOfPoints({}, {}, 257), Error);
    const test::PointShape shape = test::randomPlane(20000, 10);
    const SurfaceSites one = sitesOfPoints(shape.point, shape.normal, 8, test::onThreads(1));
    const SurfaceSites four = sitesOfPoints(shape.point, shape.normal, 8, test::onThreads(4));
    CHECK(one.neighbours == four.neighbours);
    const auto thrown = test::thrownWhenCancelled(
        [&](const RunContext& ctx) { sitesOfPoints(shape.point, shape.normal, 8, ctx); });
    CHECK(thrown.code == int(ErrorCode::Cancelled));
}

TEST_CASE("mortonOrder: a permutation that keeps near points near") {
    const test::PointShape shape = test::randomPlane(4096, 64);
    const std::vector<std::uint32_t> order = mortonOrder(shape.point);
    std::vector<std::uint32_t> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    double walked = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        REQUIRE(sorted[i] == i);
        if (i > 0) walked += double(length(shape.point[order[i]] - shape.point[order[i - 1]]));
    }
    CHECK(walked / 4096 < 2);  // in the order given it is about 33
    // Along one axis: the order of the coordinate.
    CHECK(mortonOrder({{2, 0, 0}, {0, 0, 0}, {1, 0, 0}}) == std::vector<std::uint32_t>{1, 2, 0});
}
