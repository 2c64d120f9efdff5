#include "libvdbsynth/measure/verdict.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/measure/correlation.h"
#include "tests/support/makers.h"

#include <cmath>

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

TEST_CASE("fractionError: of independent voxels the binomial's, of blocks the blocks'", "[measure][oracle]") {
    // S2 is phi at 0 and phi^2 from 1 on: only the voxel itself counts.
    CHECK(fractionError({0.25, 0.0625, 0.0625}, 0.25, 10000) == Approx(std::sqrt(0.25 * 0.75 / 10000)));
    CHECK(fractionError({0.25, 0.0625}, 0.25, 0) == 0);
    CHECK(fractionError({1, 1, 1}, 1, 1000) == 0);
    // Voxels in cubes of 4, each solid or void as a whole by chance: 16^3 independent cubes.
    constexpr int kCubes = 16, kSide = 4, kReach = 10;
    double spread = 0, predicted = 0;
    constexpr int kSamples = 60;
    for (int sample = 0; sample < kSamples; ++sample) {
        std::vector<char> solid(std::size_t(kCubes * kCubes * kCubes));
        double count = 0;
        for (std::size_t i = 0; i < solid.size(); ++i) {
            Random random(std::uint64_t(sample), i);
            solid[i] = random.uniform(0, 1) < 0.3;
            count += solid[i];
        }
        const double fraction = count / double(solid.size());
        spread += (fraction - 0.3) * (fraction - 0.3) / kSamples;
        const Occupancy voxels = Occupancy::fromField(
            test::fieldFrom({kCubes * kSide, kCubes * kSide, kCubes * kSide}, [&](const Index3& p) {
                const int cube = (p.x / kSide * kCubes + p.y / kSide) * kCubes + p.z / kSide;
                return solid[std::size_t(cube)] ? -1.f : 1.f;
            }));
        if (sample % 20 == 0)
            predicted +=
                fractionError(twoPointCorrelation(voxels, kReach).radial, fraction, double(voxels.volume())) /
                3;
    }
    CHECK(predicted == Approx(std::sqrt(spread)).epsilon(0.35));
}

TEST_CASE("judgeFraction: within two standard errors of the exemplar's own", "[measure][oracle]") {
    const auto all = [](double fraction) {
        return std::vector<Statistic>{{"volume fraction", 0, false, {fraction}},
                                      {"two-point correlation", 0, true, {0.25, 0.0625}}};
    };
    const double error = std::sqrt(0.25 * 0.75 / 1e4);
    const Verdict near = judgeFraction(all(0.25), 1e4, all(0.25 + 1.9 * error));
    CHECK(near.name == "volume fraction, standard error");
    CHECK(near.sigma == Approx(error));
    CHECK(near.passes());
    CHECK_FALSE(judgeFraction(all(0.25), 1e4, all(0.25 + 2.1 * error)).passes());
    CHECK(judgeFraction({}, 1, {}).passes());
}
