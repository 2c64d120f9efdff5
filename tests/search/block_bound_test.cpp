#include "libvdbsynth/search/block_bound.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/search/block_cost.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

LevelField inBricks(const BrickField& field) {
    return {std::make_shared<const BrickField>(field), {}};
}

LevelField asArray(const BrickField& field) {
    LevelField level;
    level.dense.size = field.box().size() + Index3{kNodeCube, kNodeCube, kNodeCube};
    level.dense.samples.resize(std::size_t(IndexBox::fromSize(level.dense.size).volume()));
    field.readBox({0, 0, 0}, level.dense.size, level.dense.samples.data());
    return level;
}

}  // namespace

TEST_CASE("queryLevel: means of cubes that are wholly known", "[search][oracle]") {
    std::vector<float> samples(64);
    for (std::size_t i = 0; i < 64; ++i) samples[i] = float(i);
    std::vector<std::uint8_t> known(64, 1);
    known[0] = 0;
    BlockQuery query;
    query.samples = samples.data();
    const QueryLevel all = queryLevel(query, 4, 2, 64);
    REQUIRE(all.mean.size() == 8);
    CHECK(all.mean[0] == 10.5f);  // 0 1 4 5 16 17 20 21
    CHECK(all.offset[1] == Index3{0, 0, 2});
    CHECK(all.weight == 8.0 / 64);
    query.known = known.data();
    const QueryLevel some = queryLevel(query, 4, 2, 63);
    CHECK(some.mean.size() == 7);
    CHECK(some.offset[0] == Index3{0, 0, 2});
}

TEST_CASE("CubeBounds: as those of single nodes, from bricks and from an array, and never above the cost",
          "[search][property]") {
    const int n = 8;
    const BrickField exemplar = test::noiseField({33, 29, 30}, 3);
    const BrickField other = test::noiseField({8, 8, 8}, 4);
    std::vector<float> samples(512);
    other.readBox({0, 0, 0}, {n, n, n}, samples.data());
    BlockQuery query;
    query.samples = samples.data();
    const float margin = 1e-6f;
    const QueryLevel level = queryLevel(query, n, 1, 512);
    const LevelBound bound(level, margin);
    CubeBounds bricks, array;
    for (const Index3 corner : {Index3{0, 0, 0}, Index3{16, 8, 16}, Index3{24, 16, 16}}) {
        const float none = std::numeric_limits<float>::infinity();
        const std::vector<float>& a = bricks.bound(bound, inBricks(exemplar), corner, none);
        const std::vector<float>& b = array.bound(bound, asArray(exemplar), corner, none);
        CHECK(a == b);
        for (int i = 0; i < 512; ++i) {
            const Index3 p = corner + Index3{i / 64, i / 8 % 8, i % 8};
            if (!blockPositions(exemplar, n).contains(p)) continue;
            const double cost = blockCost(exemplar, p, n, samples.data(), nullptr, 512, 1e30);
            const float least = bound.from(a[placeInCube(p)]);
            REQUIRE(double(least) <= cost);
            REQUIRE(double(least) == Approx(cost).epsilon(1e-3));
            REQUIRE(bound.ofNode(inBricks(exemplar), p, none) == Approx(a[placeInCube(p)]).epsilon(1e-4));
            // What is within a limit is not left out by its squares.
            REQUIRE(a[placeInCube(p)] <= bound.squaresFor(cost));
        }
    }
}

TEST_CASE("CubeBounds: what exceeds the limit may stop early but still exceeds it", "[search][property]") {
    const BrickField exemplar = test::noiseField({24, 24, 24}, 3);
    std::vector<float> samples(512, 50.f);
    BlockQuery query;
    query.samples = samples.data();
    const QueryLevel level = queryLevel(query, 8, 1, 512);
    const LevelBound bound(level, 0);
    CubeBounds cube;
    for (float sum : cube.bound(bound, inBricks(exemplar), {8, 8, 8}, 100.f)) REQUIRE(sum > 100.f);
    const float none = std::numeric_limits<float>::infinity();
    const std::vector<float> all = cube.bound(bound, inBricks(exemplar), {8, 8, 8}, none);
    for (std::uint64_t rows : {std::uint64_t(1), std::uint64_t(0x8000000000000001), std::uint64_t(0xF0F00),
                               std::uint64_t(0x123456789ABCDEF)}) {
        const std::vector<float>& some = cube.bound(bound, inBricks(exemplar), {8, 8, 8}, none, rows);
        for (std::size_t i = 0; i < 512; ++i)
            if (rows >> (i / 8) & 1) REQUIRE(some[i] == all[i]);
    }
    CHECK(bound.ofNode(inBricks(exemplar), {8, 8, 8}, 100.f) > 100.f);
}
