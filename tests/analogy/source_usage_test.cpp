#include "libvdbsynth/analogy/source_usage.h"

#include <catch2/catch.hpp>

#include <vector>

using namespace vdbsynth;

TEST_CASE("sources cost more beyond their share", "[analogy]") {
    // Parts of 4^3 voxels: the first two rows are of one, the third of the next, the fourth of another
    // exemplar.
    SourceUsage usage({{0, {0, 0, 0}}, {0, {3, 3, 3}}, {0, {4, 0, 0}}, {1, {0, 0, 0}}}, 8);
    for (int row = 0; row < 4; ++row) REQUIRE(usage.cost(row) == 1);
    for (int i = 0; i < 4; ++i) usage.change(-1, i % 2);
    CHECK(usage.cost(0) == 1);  // 4 of its 4
    usage.change(-1, 0);
    CHECK(usage.cost(0) == Approx(1.5));  // 1 + 2 (5/4 - 1)
    CHECK(usage.cost(1) == usage.cost(0));
    CHECK(usage.cost(2) == 1);
    for (int i = 0; i < 4; ++i) usage.change(0, 2);
    CHECK(usage.cost(0) == 1);
    CHECK(usage.cost(2) == Approx(3));  // 4 of its 2
    CHECK(usage.cost(3) == 1);
    for (int i = 0; i < 4; ++i) usage.change(2, -1);
    CHECK(usage.cost(2) == 1);
}

TEST_CASE("a target without voxels gives no shares", "[analogy]") {
    SourceUsage usage({{0, {0, 0, 0}}}, 0);
    usage.change(-1, 0);
    CHECK(usage.cost(0) == 1);
}
