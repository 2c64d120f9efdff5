#include "libvdbsynth/geometry/point_neighbours.h"

#include <catch2/catch.hpp>

#include <algorithm>

#include "libvdbsynth/base/parallel.h"
#include "tests/support/contexts.h"

using namespace vdbsynth;

namespace {

std::vector<Vec3f> noise(std::size_t count, std::uint64_t seed) {
    Random random(seed, 1, 2);
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back({float(random.uniform()), float(random.uniform()), float(random.uniform())});
    return points;
}

// A lattice of 6 x 6 x 6 points: many distances are equal.
std::vector<Vec3f> lattice() {
    std::vector<Vec3f> points;
    forEachVoxel(IndexBox::fromSize({6, 6, 6}), [&](const Index3& p) {
        points.push_back({float(p.x), float(p.y), float(p.z)});
    });
    return points;
}

}  // namespace

TEST_CASE("PointNeighbours: the nearest are those of a scan, nearest first", "[geometry][oracle]") {
    for (const std::vector<Vec3f>& points : {noise(500, 3), lattice()}) {
        const PointNeighbours tree(points);
        for (const Vec3f& place : noise(50, 4)) {
            std::vector<float> all;
            for (const Vec3f& p : points) all.push_back(dot(p - place, p - place));
            std::sort(all.begin(), all.end());
            std::uint32_t numbers[10];
            float squared[10];
            REQUIRE(tree.nearest(place, 10, numbers, squared) == 10);
            for (std::size_t k = 0; k < 10; ++k) {
                CHECK(squared[k] == Approx(all[k]).epsilon(1e-5));
                const Vec3f apart = points[numbers[k]] - place;
                CHECK(dot(apart, apart) == Approx(squared[k]));
            }
            std::sort(numbers, numbers + 10);
            CHECK(std::unique(numbers, numbers + 10) == numbers + 10);
        }
    }
}

TEST_CASE("PointNeighbours: fewer than asked for only if the set is smaller", "[geometry][degenerate]") {
    std::uint32_t numbers[5];
    float squared[5];
    const std::vector<Vec3f> few{{0, 0, 0}, {1, 0, 0}}, none;
    CHECK(PointNeighbours(few).nearest({0.9f, 0, 0}, 5, numbers, squared) == 2);
    CHECK(numbers[0] == 1);
    CHECK(numbers[1] == 0);
    CHECK(squared[1] == Approx(0.81f));
    CHECK(PointNeighbours(none).nearest({0, 0, 0}, 5, numbers, squared) == 0);
    // Many points at one place are all found.
    const std::vector<Vec3f> same(100, Vec3f{1, 2, 3});
    REQUIRE(PointNeighbours(same).nearest({1, 2, 4}, 5, numbers, squared) == 5);
    for (float distance : squared) CHECK(distance == 1);
    std::sort(numbers, numbers + 5);
    CHECK(std::unique(numbers, numbers + 5) == numbers + 5);
}

TEST_CASE("PointNeighbours: equal distances give the same points every time, from any thread",
          "[geometry][threads]") {
    const std::vector<Vec3f> points = lattice(), copy = points;
    const PointNeighbours tree(points), again(copy);
    const auto found = [&](const PointNeighbours& from, int threads) {
        std::vector<std::uint32_t> numbers(points.size() * 7);
        parallelFor(test::onThreads(threads), points.size(), 1, [&](std::size_t begin, std::size_t end) {
            float squared[7];
            for (std::size_t i = begin; i < end; ++i)
                from.nearest(points[i] + Vec3f{0.5f, 0.5f, 0.5f}, 7, &numbers[i * 7], squared);
        });
        return numbers;
    };
    CHECK(found(tree, 1) == found(tree, 4));
    CHECK(found(tree, 1) == found(again, 1));
}
