#include "libvdbsynth/geometry/ear_clipping.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"

#include <cmath>
#include <map>

using namespace vdbsynth;

namespace {

using Ring = std::vector<PlanePoint>;

double ringArea(const Ring& ring) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        area += double(doubleArea(ring[0], ring[i], ring[i + 1]));
    return area;
}

// Edges of the triangles without those that two of them share: the ring's.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> borderOf(const std::vector<Triangle>& triangles) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = t[i], b = t[(i + 1) % 3];
            if (--edges[{b, a}] < 0) {
                ++edges[{b, a}];
                ++edges[{a, b}];
            }
        }
    return edges;
}

void checkCovers(const Ring& ring) {
    EarClipper clipper;
    std::vector<Triangle> triangles;
    CHECK(clipper.triangulate(ring, triangles));
    REQUIRE(triangles.size() == ring.size() - 2);
    double covered = 0;
    std::size_t flipped = 0;
    for (const Triangle& t : triangles) {
        const double area = double(doubleArea(ring[t[0]], ring[t[1]], ring[t[2]]));
        covered += std::abs(area);
        flipped += area < 0;
    }
    CHECK(flipped == 0);
    CHECK(covered == Approx(ringArea(ring)).epsilon(1e-12));
    std::size_t found = 0;
    for (const auto& [edge, times] : borderOf(triangles)) {
        if (times == 0) continue;
        found += times == 1 && (edge.first + 1) % ring.size() == edge.second;
    }
    CHECK(found == ring.size());
}

Ring star(std::uint64_t seed, std::size_t corners) {
    Ring ring;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = 2 * M_PI * double(i) / double(corners);
        const double radius = 5e8 * Random(seed, i).uniform(0.1, 1);
        ring.push_back(
            {std::int64_t(1e9 + radius * std::cos(angle)), std::int64_t(1e9 + radius * std::sin(angle))});
    }
    return ring;
}

// Teeth along a slanted line, of uneven lengths.
Ring comb(std::uint64_t seed, std::size_t teeth) {
    Ring ring{{0, 0}, {kPlaneMost / 2, kPlaneMost / 2}};
    const double step = double(kPlaneMost / 2) / double(teeth);
    for (std::size_t i = teeth; i-- > 0;) {
        const double at = step * double(i), high = 1e8 + 8e8 * Random(seed, i).uniform(0, 1);
        const auto point = [](double along, double up) {
            return PlanePoint{std::int64_t(along), std::int64_t(along + up)};
        };
        ring.push_back(point(at + step * 0.6, high));
        ring.push_back(point(at + step * 0.2, 1e6));
    }
    return ring;
}

}  // namespace

TEST_CASE("EarClipper: a dart, a comb and a spiral by hand", "[geometry][hand]") {
    checkCovers({{0, 0}, {4, 1}, {8, 0}, {4, 8}});
    checkCovers({{0, 0}, {10, 0}, {10, 10}, {8, 10}, {8, 2}, {6, 2}, {6, 10}, {4, 10}, {4, 2}, {0, 2}});
    checkCovers(
        {{0, 0}, {10, 0}, {10, 10}, {2, 10}, {2, 4}, {6, 4}, {6, 6}, {4, 6}, {4, 8}, {8, 8}, {8, 2}, {0, 2}});
}

TEST_CASE("EarClipper: collinear corners are used without triangles of zero area", "[geometry][degenerate]") {
    const Ring ring{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 1}, {4, 2}, {4, 4}, {2, 2}, {1, 1}};
    checkCovers(ring);
    EarClipper clipper;
    std::vector<Triangle> triangles;
    clipper.triangulate(ring, triangles);
    for (const Triangle& t : triangles) CHECK(doubleArea(ring[t[0]], ring[t[1]], ring[t[2]]) > 0);
}

TEST_CASE("EarClipper: rings that touch themselves", "[geometry][degenerate]") {
    // A square hole behind a bridge.
    checkCovers({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}});
    // Two holes behind bridges from one corner.
    checkCovers({{0, 0},
                 {20, 0},
                 {20, 20},
                 {0, 20},
                 {0, 0},
                 {3, 6},
                 {3, 9},
                 {6, 9},
                 {6, 6},
                 {3, 6},
                 {0, 0},
                 {9, 3},
                 {9, 6},
                 {15, 6},
                 {15, 3},
                 {9, 3}});
    // A notch that reaches the opposite apex, beyond the diagonal of that apex.
    checkCovers({{30, 40}, {10, 10}, {20, 0}, {30, 40}, {40, 0}, {50, 10}});
    // A tip that touches an edge from inside, and one that touches from outside.
    checkCovers({{0, 0}, {10, 0}, {10, 10}, {6, 10}, {5, 0}, {4, 10}, {0, 10}});
    checkCovers({{0, 0}, {10, 0}, {10, 2}, {2, 2}, {2, 8}, {6, 8}, {6, 2}, {8, 8}, {8, 10}, {0, 10}});
    // Corners that come twice in a row, and a spike.
    checkCovers({{0, 0}, {10, 0}, {10, 0}, {10, 10}, {5, 5}, {5, 5}, {5, 5}, {0, 10}});
    checkCovers({{0, 0}, {10, 0}, {10, 10}, {5, 5}, {5, 8}, {5, 5}, {0, 10}});
}

TEST_CASE("EarClipper: random stars and combs are covered", "[geometry][property]") {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        CAPTURE(seed);
        checkCovers(star(seed, 5 + seed * 7));
        checkCovers(comb(seed, 1 + seed * 3));
    }
}

TEST_CASE("EarClipper: rows of holes behind bridges", "[geometry][property]") {
    for (const std::int64_t rows : {1, 3, 12, 60}) {
        const std::int64_t side = 1000 * (rows + 1);
        Ring ring{{0, 0}, {side, 0}, {side, side}, {0, side}};
        for (std::int64_t y = rows * 1000; y > 0; y -= 1000) {
            // There along the tops of a row of diamonds, back along their bottoms.
            ring.push_back({0, y});
            for (std::int64_t x = 1000; x < side; x += 1000)
                ring.insert(ring.end(), {{x - 300, y}, {x, y + 300}, {x + 300, y}});
            for (std::int64_t x = side - 1000; x > 0; x -= 1000) {
                if (x < side - 1000) ring.push_back({x + 300, y});
                ring.insert(ring.end(), {{x, y - 300}, {x - 300, y}});
            }
            ring.push_back({0, y});
        }
        CHECK(ringArea(ring) == 2.0 * double(side * side - rows * rows * 180000));
        checkCovers(ring);
    }
}

TEST_CASE("EarClipper: a hundred thousand corners", "[geometry][fast]") {
    checkCovers(star(1, 100000));
    checkCovers(comb(2, 20000));
    Ring circle;
    for (int i = 0; i < 100000; ++i)
        circle.push_back({std::int64_t(1e9 + 1e9 * std::cos(i * 2e-5 * M_PI)),
                          std::int64_t(1e9 + 1e9 * std::sin(i * 2e-5 * M_PI))});
    checkCovers(circle);
}

TEST_CASE("EarClipper: rings that cross themselves are reported and keep their signed area",
          "[geometry][hostile]") {
    EarClipper clipper;
    std::vector<Triangle> triangles;
    const auto check = [&](const Ring& ring) {
        CHECK_FALSE(clipper.triangulate(ring, triangles));
        REQUIRE(triangles.size() == ring.size() - 2);
        double area = 0;
        for (const Triangle& t : triangles) area += double(doubleArea(ring[t[0]], ring[t[1]], ring[t[2]]));
        CHECK(area == Approx(ringArea(ring)));
    };
    check({{0, 0}, {10, 10}, {10, 0}, {0, 10}, {-5, 5}});
    const Ring five = {{10, 0}, {13, 10}, {5, 4}, {15, 4}, {7, 10}};
    check(five);
    for (const std::size_t corners : {50u, 3000u, 100000u}) {
        Ring wild;
        for (std::size_t i = 0; i < corners; ++i) {
            Random random(7, i);
            wild.push_back({std::int64_t(random.uniform(0, 2e9)), std::int64_t(random.uniform(0, 2e9))});
        }
        if (ringArea(wild) < 0) std::reverse(wild.begin(), wild.end());
        check(wild);
    }
}

TEST_CASE("EarClipper: fewer than three corners, and rings without area", "[geometry][degenerate]") {
    EarClipper clipper;
    std::vector<Triangle> triangles{{1, 2, 3}};
    CHECK(clipper.triangulate({{0, 0}, {1, 1}}, triangles));
    CHECK(triangles.empty());
    CHECK(clipper.triangulate({{0, 0}, {1, 1}, {2, 2}, {5, 5}, {3, 3}}, triangles));
    CHECK(triangles.size() == 3);
    CHECK(clipper.triangulate(Ring(6, PlanePoint{4, 4}), triangles));
    CHECK(triangles.size() == 4);
}
