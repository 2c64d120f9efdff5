#include "libvdbsynth/synth/patch_search.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("patchDifference: the mean of squares, for any side, and what gives up is too much",
          "[synth][oracle]") {
    const BrickField noise = test::noiseField({40, 41, 43}, 5);
    const DenseField dense = denseField(noise);
    for (int n : {4, 5, 8, 11, 12, 16, 19}) {
        std::vector<float> patch(std::size_t(n) * std::size_t(n) * std::size_t(n));
        noise.readBox({2, 3, 1}, {n, n, n}, patch.data());
        const PatchView view{patch.data(), n * n, n};
        CHECK(patchDifference(view, dense, {2, 3, 1}, n, 1e9f) == 0.f);
        const Index3 at{17, 9, 20};
        double expected = 0;
        std::size_t i = 0;
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y)
                for (int z = 0; z < n; ++z, ++i) {
                    const double d = double(patch[i]) - double(noise.at(at + Index3{x, y, z}));
                    expected += d * d / double(patch.size());
                }
        const float cost = patchDifference(view, dense, at, n, 1e9f);
        CHECK(double(cost) == Approx(expected).epsilon(1e-5));
        CHECK(patchDifference(view, dense, at, n, cost / 3) > cost / 3);
    }
}

TEST_CASE("improveSources: finds the shift of a copy from sources that are all wrong", "[synth][property]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({48, 48, 48}, 2, 5.f, 25));
    const Index3 shift{9, 4, 7};
    const BrickField target =
        test::fieldFrom({24, 24, 24}, [&](const Index3& p) { return exemplar->at(p + shift); });
    BlockSynthesisOptions options;
    options.size = {24, 24, 24};
    const SynthesisPass pass{{exemplar}, {24, 24, 24}, 8, 1};
    PatchMap map;
    map.target = pass.target;
    map.block = 8;
    map.stride = 2;
    map.allocate();
    const PatchLevel level = patchLevel(pass, options, map, {}, nullptr, {});
    CHECK(sourcesFor(level, map, 0, {0, 0, 0}) == IndexBox{{0, 0, 0}, {40, 40, 40}});
    double before = 1e9;
    for (int round = 0; round < 20; ++round) {
        const RoundCounts counts = improveSources(level, target, round, map, {});
        CHECK(counts.compared > 0);
        CHECK(counts.cost < before * 1.2 + 0.01);
        before = counts.cost;
    }
    std::size_t right = 0;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        right += map.source[i] - map.originOf(map.place(i)) == shift;
        REQUIRE((map.weight[i] > 0 && map.weight[i] <= 1));
    }
    // Some sources go elsewhere, since the best one may be in use too often.
    CHECK(double(right) > 0.75 * double(map.source.size()));
}
