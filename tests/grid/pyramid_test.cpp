#include "libvdbsynth/grid/pyramid.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("slidingMean: every voxel holds the mean of the cube that begins there", "[grid][oracle]") {
    for (int cell : {1, 2, 3, 8, 11, 12}) {
        const BrickField field = test::noiseField({21, 17, 19}, 4);
        const BrickField mean = slidingMean(field, cell);
        for (const Index3& p : {Index3{0, 0, 0}, Index3{3, 5, 7}, Index3{21 - cell, 17 - cell, 19 - cell},
                                Index3{20, 16, 18}}) {
            double sum = 0;
            for (int x = 0; x < cell; ++x)
                for (int y = 0; y < cell; ++y)
                    for (int z = 0; z < cell; ++z) sum += double(field.at(p + Index3{x, y, z}));
            CHECK(mean.at(p) == Approx(sum / (cell * cell * cell)).margin(1e-6));
        }
    }
    CHECK(test::thrownBy([] {
              slidingMean(test::noiseField({8, 8, 8}, 1), 0);
          }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("twiceSlidingMean: the mean of the cube of twice the side", "[grid][oracle]") {
    const BrickField field = test::noiseField({30, 17, 19}, 4);
    for (int cell : {1, 3, 5}) {
        const BrickField twice = twiceSlidingMean(slidingMean(field, cell), cell);
        const BrickField direct = slidingMean(field, 2 * cell);
        for (const Index3& p : {Index3{0, 0, 0}, Index3{7, 5, 7}, Index3{29, 16, 18}, Index3{20, 1, 12}})
            CHECK(twice.at(p) == direct.at(p));
        double sum = 0;
        for (int x = 0; x < 2 * cell; ++x)
            for (int y = 0; y < 2 * cell; ++y)
                for (int z = 0; z < 2 * cell; ++z) sum += double(field.at(Index3{2, 3, 4} + Index3{x, y, z}));
        CHECK(twice.at({2, 3, 4}) == Approx(sum / (8 * cell * cell * cell)).margin(1e-6));
    }
}

TEST_CASE("slidingMean: constant regions stay exactly constant and unstored", "[grid][property]") {
    const BrickField field =
        test::fieldFrom({64, 64, 64}, [](const Index3& p) { return p.x < 8 ? float(p.y % 3) : 0.1f; });
    const BrickField mean = slidingMean(field, 8);
    CHECK(mean.storedBricks() <= 64);
    CHECK(mean.at({40, 40, 40}) == 0.1f);
}

TEST_CASE("halved: the mean of 2x2x2, odd sides average what there is", "[grid][oracle]") {
    const BrickField field = test::noiseField({9, 8, 7}, 5);
    const BrickField half = halved(field);
    CHECK(half.box().size() == Index3{5, 4, 4});
    for (const Index3& p : {Index3{0, 0, 0}, Index3{2, 3, 1}, Index3{4, 3, 3}}) {
        double sum = 0;
        for (int c = 0; c < 8; ++c) sum += double(field.at(p * 2 + Index3{c >> 2, (c >> 1) & 1, c & 1}));
        CHECK(half.at(p) == Approx(sum / 8).margin(1e-6));
    }
}

TEST_CASE("doubled: a linear field comes back exactly away from the faces", "[grid][property]") {
    const auto linear = [](const Index3& p) { return float(2 * p.x - p.y + 3 * p.z); };
    const BrickField back = doubled(halved(test::fieldFrom({24, 18, 20}, linear)), {24, 18, 20});
    CHECK(back.box().size() == Index3{24, 18, 20});
    for (int x = 1; x < 23; ++x)
        for (int y = 1; y < 17; ++y)
            for (int z = 1; z < 19; ++z)
                REQUIRE(back.at({x, y, z}) == Approx(linear({x, y, z})).margin(1e-4));
}

TEST_CASE("halvedMask: a coarse sample counts only if all of its fine ones do", "[grid][oracle]") {
    const BrickField mask =
        test::fieldFrom({6, 4, 4}, [](const Index3& p) { return p.x < 3 && p.y < 2 ? 1.f : 0.f; });
    const BrickField half = halvedMask(mask);
    CHECK(half.box().size() == Index3{3, 2, 2});
    for (const Index3& p : {Index3{0, 0, 0}, Index3{1, 0, 0}, Index3{0, 1, 1}, Index3{0, 0, 1}})
        CHECK(half.at(p) == (p.x == 0 && p.y == 0 ? 1.f : 0.f));
}
