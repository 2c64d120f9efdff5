#include "libvdbsynth/synth/patch_level.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

TEST_CASE("liftSources: a coarse copy becomes a fine one, within the exemplar", "[synth][property]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({48, 48, 48}, 2, 5.f, 25));
    BlockSynthesisOptions options;
    options.size = {64, 64, 64};
    const auto mapOf = [](const Index3& target, int block) {
        PatchMap map;
        map.target = target;
        map.block = block;
        map.stride = 2;
        map.allocate();
        return map;
    };
    const SynthesisPass pass{{exemplar}, {64, 64, 64}, 8, 1};
    PatchMap coarse = mapOf({32, 32, 32}, 6), fine = mapOf({64, 64, 64}, 8);
    const Index3 shift{-4, 3, 1};
    for (std::size_t i = 0; i < coarse.source.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            coarse.source[i][axis] = std::clamp(coarse.originOf(coarse.place(i))[axis] + shift[axis], 0, 18);
    const PatchLevel level = patchLevel(pass, options, fine, {}, nullptr, {});
    liftSources(level, coarse, 2, fine, {});
    for (std::size_t i = 0; i < fine.source.size(); ++i) {
        const Index3 l = fine.place(i), origin = fine.originOf(l);
        REQUIRE(IndexBox{{0, 0, 0}, {40, 40, 40}}.contains(fine.source[i]));
        if (std::min({origin.x, origin.y, origin.z}) >= 12 && std::max({origin.x, origin.y, origin.z}) <= 30)
            REQUIRE(fine.source[i] == origin + shift * 2);
    }
}

TEST_CASE("patchLevel: what is fixed, what repeats, where a mask leaves places", "[synth][oracle]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({24, 24, 24}, 2, 5.f, 9));
    BlockSynthesisOptions options;
    options.size = {40, 24, 24};
    options.border = {Border::Tile, Border::Cut, Border::Cut};
    options.around = {8, 0, 0};
    const SynthesisPass pass{{exemplar}, {40, 24, 24}, 8, 1};
    PatchMap map;
    map.target = pass.target;
    map.block = 8;
    map.stride = 2;
    map.allocate();
    const BrickField open =
        test::fieldFrom({40, 24, 24}, [](const Index3& p) { return p.y >= 16 ? 1.f : 0.f; });
    const BrickField mask =
        test::fieldFrom({24, 24, 24}, [](const Index3& p) { return p.z < 9 ? 1.f : 0.f; });
    const PatchLevel level = patchLevel(pass, options, map, {&mask}, &open, {});
    REQUIRE(level.repeats.size() == map.source.size());
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const Index3 origin = map.originOf(map.place(i));
        // Bricks of 8 are what `open` is known by: nothing open before y = 16.
        CHECK(bool(level.fixed[i]) == (origin.y + 8 <= 16));
        // The period is 24, from 8 on.
        const Index3 other = map.originOf(map.place(level.repeats[i]));
        CHECK((origin.x - other.x) % 24 == 0);
        CHECK((other.x >= 8 && other.x < 32));
        CHECK((other.y == origin.y && other.z == origin.z));
    }
    REQUIRE_FALSE(level.fallbacks[0].empty());
    for (const Index3& p : level.fallbacks[0]) CHECK(p.z <= 1);
    for (std::size_t i = 0; i < map.source.size(); ++i) map.source[i] = map.place(i);
    copyRepeats(level, map);
    for (std::size_t i = 0; i < map.source.size(); ++i) CHECK(map.source[i] == map.place(level.repeats[i]));
}
