#include "libvdbsynth/search/block_cost.h"

#include <catch2/catch.hpp>

#include <limits>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("blockCost: by hand, over all samples and over the known ones", "[search][fast]") {
    const BrickField field = test::fieldFrom({8, 8, 8}, [](const Index3& p) { return float(p.z); });
    std::vector<float> query(64, 0.f);
    std::vector<std::uint8_t> known(64, 0);
    const double inf = std::numeric_limits<double>::infinity();
    CHECK(blockCost(field, {0, 0, 0}, 4, query.data(), nullptr, 64, inf) == Approx((0 + 1 + 4 + 9) / 4.0));
    CHECK(blockCost(field, {0, 0, 2}, 4, query.data(), nullptr, 64, inf) == Approx((4 + 9 + 16 + 25) / 4.0));
    known[1] = known[3] = 1;  // z = 1 and z = 3
    CHECK(countKnown(known.data(), 4) == 2);
    CHECK(blockCost(field, {0, 0, 0}, 4, query.data(), known.data(), 2, inf) == Approx((1 + 9) / 2.0));
}

TEST_CASE("blockCost: an early return is never below the limit, a full one is exact", "[search][property]") {
    const BrickField field = test::noiseField({20, 20, 20}, 1);
    const std::vector<float> query = test::samplesOf(test::noiseField({9, 9, 9}, 2));
    const double exact = blockCost(field, {3, 4, 5}, 9, query.data(), nullptr, 729, 1e9);
    double sum = 0;
    for (int x = 0; x < 9; ++x)
        for (int y = 0; y < 9; ++y)
            for (int z = 0; z < 9; ++z) {
                const double d =
                    double(field.at({3 + x, 4 + y, 5 + z})) - double(query[std::size_t((x * 9 + y) * 9 + z)]);
                sum += d * d;
            }
    CHECK(exact == Approx(sum / 729).epsilon(1e-6));
    CHECK(blockCost(field, {3, 4, 5}, 9, query.data(), nullptr, 729, exact) == exact);
    CHECK(blockCost(field, {3, 4, 5}, 9, query.data(), nullptr, 729, exact / 3) > exact / 3);
    const DenseField dense = denseField(field);
    for (double giveUp : {1e9, exact, exact / 3})
        CHECK(blockCost(dense, {3, 4, 5}, 9, query.data(), nullptr, 729, giveUp) ==
              blockCost(field, {3, 4, 5}, 9, query.data(), nullptr, 729, giveUp));
}
