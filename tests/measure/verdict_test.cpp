#include "libvdbsynth/measure/verdict.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

Statistic numberOf(double value) {
    return {"number", 0, false, {value}};
}

}  // namespace

TEST_CASE("judge: mean, sigma and quartile of eight parts, by hand", "[measure][oracle]") {
    std::vector<Statistic> parts;
    for (double value : {1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0}) parts.push_back(numberOf(value));
    // Mean 5; distances 4 3 2 1 1 2 3 4; sigma sqrt(60 / 7); the sixth smallest distance is 3.
    const Verdict near = judge(parts, numberOf(7.5));
    CHECK(near.mean == 5);
    CHECK(near.sigma == Approx(std::sqrt(60.0 / 7)));
    CHECK(near.quartile == 3);
    CHECK(near.distance == 2.5);
    CHECK(near.passes());
    CHECK(near.away() == Approx(2.5 / std::sqrt(60.0 / 7)));
    CHECK_FALSE(judge(parts, numberOf(8.5)).passes());  // within two sigma, beyond the quartile
    CHECK(judge({numberOf(2), numberOf(2)}, numberOf(2)).passes());
    CHECK_FALSE(judge({numberOf(2), numberOf(2)}, numberOf(2.1)).passes());
    CHECK(judgeDistance("d", {1, 1, 1, 1}, 0.9).passes());
    CHECK_FALSE(judgeDistance("d", {1, 1, 1, 1}, 1.1).passes());
}

TEST_CASE("meanOf: number by number", "[measure][oracle]") {
    const Statistic a{"c", 0, true, {0, 1, 2, 3}}, b{"c", 0, true, {0, 1, 2, 5}};
    CHECK(meanOf({a, b}).values == std::vector<double>{0, 1, 2, 4});
}

TEST_CASE("subVolumes: eight halves, nine columns, eight slices, none if too small", "[measure][oracle]") {
    const IndexBox box{{4, 4, 4}, {67, 68, 69}};
    const std::vector<IndexBox> halves = subVolumes(box, {true, true, true}, 16);
    REQUIRE(halves.size() == 8);
    CHECK(halves[0] == IndexBox{{4, 4, 4}, {35, 35, 36}});
    CHECK(halves[7].min == Index3{36, 36, 37});
    for (const IndexBox& part : halves) CHECK(box.contains(part));
    const std::vector<IndexBox> columns = subVolumes(box, {true, true, false}, 16);
    REQUIRE(columns.size() == 9);
    CHECK(columns[0].size() == Index3{21, 21, 66});
    // How thin a slab is across does not matter.
    CHECK(subVolumes({{0, 0, 0}, {95, 95, 8}}, {true, true, false}, 16).size() == 9);
    CHECK(subVolumes(box, {true, false, false}, 8).size() == 8);
    CHECK(subVolumes(box, {true, false, false}, 9).empty());
    CHECK(subVolumes(box, {false, false, false}, 1).empty());
}

TEST_CASE("Yardstick: the ratio has at least the shift below it", "[measure][oracle]") {
    CHECK(Yardstick{"y", 2, 4, 1}.ratio() == Approx(0.5));
    CHECK(Yardstick{"y", 2, 1, 4}.ratio() == Approx(0.5));
    CHECK(Yardstick{"y", 0, 0, 0}.ratio() == 0);
}
