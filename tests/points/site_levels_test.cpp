#include "libvdbsynth/points/site_levels.h"

#include "libvdbsynth/base/error.h"
#include "tests/support/contexts.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

using namespace vdbsynth;

TEST_CASE("cellOf: floors, also below zero, and holds far outliers") {
    const Index3 cell = cellOf({2.5f, -0.1f, 4}, 2);
    CHECK(cell.x == 1);
    CHECK(cell.y == -1);
    CHECK(cell.z == 2);
    CHECK(cellOf({1e30f, -1e30f, 0}, 1e-6).x == 1 << 30);
    CHECK(cellOf({1e30f, -1e30f, 0}, 1e-6).y == -(1 << 30));
}

TEST_CASE("mergedByCells: a lattice of 4 x 4 becomes its 2 x 2 means") {
    const test::PointShape shape = test::latticePlane(4);
    const CoarserSites coarser = mergedByCells(shape.point, shape.normal, 2);
    REQUIRE(coarser.point.size() == 4);
    for (std::size_t i = 0; i < shape.point.size(); ++i) {
        const Vec3f& p = coarser.point[coarser.parent[i]];
        CHECK(p.x == (shape.point[i].x < 2 ? 0.5f : 2.5f));
        CHECK(p.y == (shape.point[i].y < 2 ? 0.5f : 2.5f));
        CHECK(coarser.normal[coarser.parent[i]].z == 1);
    }
}

TEST_CASE("mergedByCells: the two sides of a thin wall stay apart") {
    test::PointShape wall = test::latticePlane(8);
    const std::size_t half = wall.point.size();
    for (std::size_t i = 0; i < half; ++i) {
        wall.point.push_back(wall.point[i] + Vec3f{0, 0, 0.01f});
        wall.normal.push_back({0, 0, -1});
    }
    const CoarserSites coarser = mergedByCells(wall.point, wall.normal, 4);
    CHECK(coarser.point.size() == 8);
    for (std::size_t i = 0; i < wall.point.size(); ++i)
        CHECK(coarser.normal[coarser.parent[i]].z == wall.normal[i].z);
}

TEST_CASE("mergedByCells: on a ball the number falls with the square of the cell") {
    const test::PointShape ball = test::spiralSphere(50000, 10);
    const std::size_t one = mergedByCells(ball.point, ball.normal, 1).point.size();
    const std::size_t two = mergedByCells(ball.point, ball.normal, 2).point.size();
    CHECK(double(one) / double(two) == Approx(4).margin(0.3));
}

TEST_CASE("mergedByCells: nothing, huge coordinates, bad cells, threads") {
    CHECK(mergedByCells({}, {}, 1).point.empty());
    CHECK(mergedByCells({{1e30f, 0, 0}, {-1e30f, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}, 1e-6).point.size() == 2);
    CHECK_THROWS_AS(mergedByCells({}, {}, 0), Error);
    const test::PointShape shape = test::randomPlane(30000, 100);
    const CoarserSites one = mergedByCells(shape.point, shape.normal, 3, test::onThreads(1));
    const CoarserSites four = mergedByCells(shape.point, shape.normal, 3, test::onThreads(4));
    CHECK(one.parent == four.parent);
}
