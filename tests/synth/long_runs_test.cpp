#include "libvdbsynth/synth/long_runs.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/synth/patch_search.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// Patches of 4 voxels, 2 apart, over a target of 26 x 4 x 4: twelve in a row, all from one shift.
PatchMap rowOfPatches() {
    PatchMap map;
    map.target = {26, 4, 4};
    map.block = 4;
    map.stride = 2;
    map.allocate();
    for (std::size_t i = 0; i < map.source.size(); ++i) map.source[i] = map.originOf(map.place(i));
    return map;
}

PatchLevel levelWith(double surfacePlaces) {
    PatchLevel level;
    level.surfacePlaces = {surfacePlaces, surfacePlaces};
    return level;
}

using Marks = std::vector<std::uint8_t>;

}  // namespace

TEST_CASE("patchesTooMany: of a long run those stay that are nearest to its middle", "[synth][oracle]") {
    PatchMap map = rowOfPatches();
    REQUIRE(map.source.size() == 12);
    Marks counted(12, 1);
    CHECK(patchesTooMany(levelWith(24), map, counted, 0.5) == Marks(12, 0));
    // The middle is place 5; five patches stay.
    CHECK(patchesTooMany(levelWith(10), map, counted, 0.5) == Marks{1, 1, 1, 0, 0, 0, 0, 0, 1, 1, 1, 1});
    // Runs end at patches that do not count, and where sources go elsewhere or to another exemplar.
    counted[2] = 0;
    map.source[6].y += 1;
    map.exemplar[9] = 1;
    CHECK(patchesTooMany(levelWith(4), map, counted, 0.5) == Marks{0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0});
    CHECK(patchesTooMany(levelWith(6), map, counted, 0.5) == Marks(12, 0));
}

TEST_CASE("patchesTooMany: one patch is never too many", "[synth][degenerate]") {
    const PatchMap map = rowOfPatches();
    const Marks marks = patchesTooMany(levelWith(0), map, Marks(12, 1), 0.5);
    CHECK(std::count(marks.begin(), marks.end(), 1) == 11);
    CHECK(patchesTooMany(levelWith(0), map, Marks(12, 0), 0.5) == Marks(12, 0));
}

TEST_CASE("shortenRuns: a copy of all is cut to the share that may be copied in one piece",
          "[synth][property]") {
    // Slabs: a patch that is moved along them is a copy as well.
    const auto exemplar = std::make_shared<const BrickField>(
        test::fieldFrom({48, 48, 48}, [](const Index3& p) { return std::abs(float(p.x % 16) - 8.f) - 4.f; }));
    const BrickField target = test::fieldFrom({40, 40, 40}, [&](const Index3& p) { return exemplar->at(p); });
    BlockSynthesisOptions options;
    options.size = {40, 40, 40};
    options.longestRun = 0.15;
    const SynthesisPass pass{{exemplar}, options.size, 8, 1};
    PatchMap map;
    map.target = pass.target;
    map.block = 8;
    map.stride = 2;
    map.allocate();
    for (std::size_t i = 0; i < map.source.size(); ++i) map.source[i] = map.originOf(map.place(i));
    map.weight.assign(map.source.size(), 1);
    const PatchLevel level = patchLevel(pass, options, map, {}, nullptr, {});
    const std::size_t moved = shortenRuns(level, target, 0, map, {});
    CHECK(moved > map.source.size() / 2);
    std::size_t still = 0;
    for (std::size_t i = 0; i < map.source.size(); ++i) still += map.source[i] == map.originOf(map.place(i));
    CHECK(still < map.source.size() * 2 / 3);
    for (int round = 1; round < 6; ++round) shortenRuns(level, target, round, map, {});
    CHECK(shortenRuns(level, target, 6, map, {}) < moved / 10);
}
