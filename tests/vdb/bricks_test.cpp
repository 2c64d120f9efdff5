#include "libvdbsynth/vdb/bricks.h"

#include <openvdb/openvdb.h>
#include <catch2/catch.hpp>

#include "libvdbsynth/vdb/level_set.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("scatterBricks, gatherBricks: there and back is the identity, at any alignment",
          "[vdb][property]") {
    openvdb::initialize();
    const BrickField field = test::ballsField({37, 41, 30}, 1, 3.f);
    for (const Index3& corner : {Index3{0, 0, 0}, Index3{-13, 5, 127}, Index3{3, -8, -1}}) {
        const FloatGridPtr grid = scatterBricks(field, corner, 0.5f, 3.f);
        CHECK(grid->background() == 1.5f);
        const IndexBox box{corner, corner + Index3{36, 40, 29}};
        CHECK(test::samplesOf(gatherBricks(*grid, box, 2.f, 3.f)) == test::samplesOf(field));
        // Only the band is active; the deep inside is inactive and negative.
        for (auto it = grid->cbeginValueOn(); it; ++it) REQUIRE(std::abs(*it) < 1.5f);
    }
}

TEST_CASE("gatherBricks: a million-voxel box of nothing stores nothing", "[vdb][degenerate]") {
    const auto grid = openvdb::FloatGrid::create(3.f);
    const BrickField field = gatherBricks(*grid, IndexBox::fromSize({800, 700, 900}), 1.f, 3.f);
    CHECK(field.storedBricks() == 0);
    CHECK(field.at({5, 5, 5}) == 3.f);
}

TEST_CASE("scatterBricks: the same tree for any number of threads", "[vdb][determinism]") {
    const BrickField field = test::ballsField({60, 60, 60}, 2, 3.f);
    RunContext one, two;
    one.threads = 1;
    two.threads = 2;
    CHECK(levelSetHash(*scatterBricks(field, {1, 2, 3}, 1.f, 3.f, one)) ==
          levelSetHash(*scatterBricks(field, {1, 2, 3}, 1.f, 3.f, two)));
}
