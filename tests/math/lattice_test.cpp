#include "libvdbsynth/math/lattice.h"

#include <catch2/catch.hpp>

#include <set>
#include <vector>

using namespace vdbsynth;

TEST_CASE("forEachVoxel: x slowest, z fastest, with a step, none of an empty box", "[math]") {
    std::vector<Index3> visited;
    const auto visit = [&](const Index3& p) { visited.push_back(p); };
    forEachVoxel({{-1, 0, 5}, {0, 1, 6}}, visit);
    const std::vector<Index3> expected{{-1, 0, 5}, {-1, 0, 6}, {-1, 1, 5}, {-1, 1, 6},
                                       {0, 0, 5},  {0, 0, 6},  {0, 1, 5},  {0, 1, 6}};
    CHECK(visited == expected);
    visited.clear();
    forEachVoxel({{0, 0, 0}, {4, 0, 3}}, visit, 2);
    CHECK(visited == std::vector<Index3>{{0, 0, 0}, {0, 0, 2}, {2, 0, 0}, {2, 0, 2}, {4, 0, 0}, {4, 0, 2}});
    visited.clear();
    forEachVoxel(IndexBox{}, visit);
    CHECK(visited.empty());
}

TEST_CASE("latticeIndex and latticeVoxel: inverse, in the order of forEachVoxel", "[math][property]") {
    const Index3 size{3, 4, 5};
    CHECK(latticeCount(size) == 60);
    CHECK(latticeCount({0, 4, 5}) == 0);
    std::size_t next = 0;
    forEachVoxel(IndexBox::fromSize(size), [&](const Index3& p) {
        CHECK(latticeIndex(p, size) == next);
        CHECK(latticeVoxel(next, size) == p);
        ++next;
    });
    // Products beyond 2^31 do not wrap.
    const Index3 large{1 << 12, 1 << 12, 1 << 12}, last{4095, 4095, 4095};
    CHECK(latticeIndex(last, large) == (std::size_t(1) << 36) - 1);
    CHECK(latticeVoxel((std::size_t(1) << 36) - 1, large) == last);
}

TEST_CASE("kFaceNeighbours, kAllNeighbours: each neighbour once, with its opposite", "[math]") {
    CHECK(std::set<Index3>(kFaceNeighbours.begin(), kFaceNeighbours.end()).size() == 6);
    const std::set<Index3> all(kAllNeighbours.begin(), kAllNeighbours.end());
    CHECK(all.size() == 26);
    CHECK(all.count({0, 0, 0}) == 0);
    for (const Index3& step : kFaceNeighbours) CHECK(all.count(step) == 1);
    for (std::size_t i = 0; i < 26; ++i) CHECK(kAllNeighbours[i] + kAllNeighbours[25 - i] == Index3{0, 0, 0});
}
