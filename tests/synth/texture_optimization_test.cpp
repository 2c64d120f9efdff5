#include "libvdbsynth/synth/texture_optimization.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <set>

using namespace vdbsynth;

namespace {

std::shared_ptr<const BrickField> shared(BrickField field) {
    return std::make_shared<const BrickField>(std::move(field));
}

BlockSynthesisOptions optionsFor(const Index3& size, int block, int levels) {
    BlockSynthesisOptions options;
    options.size = size;
    options.block = block;
    options.levels = levels;
    return options;
}

}  // namespace

TEST_CASE("optimizeTexture: a periodic exemplar goes on periodically", "[synth][property]") {
    const auto exemplar = shared(test::periodicField({32, 32, 32}, 8));
    const BlockSynthesisResult result = optimizeTexture({exemplar}, optionsFor({64, 56, 32}, 8, 2));
    CHECK(result.stats.meanCost < 1e-3);
    std::size_t same = 0, all = 0;
    for (int x = 0; x < 56; ++x)
        for (int y = 0; y < 48; ++y)
            for (int z = 0; z < 32; ++z, ++all)
                same += std::abs(result.field.at({x, y, z}) - result.field.at({x + 8, y + 8, z})) < 0.05f;
    CHECK(double(same) > 0.98 * double(all));
}

TEST_CASE("optimizeTexture: costs less than the blocks it begins with, and uses more of the exemplar",
          "[synth][property]") {
    const auto exemplar = shared(test::ballsField({48, 48, 48}, 3, 6.f, 30));
    const BlockSynthesisOptions options = optionsFor({80, 80, 48}, 12, 2);
    const auto places = [](const PatchMap& map) {
        std::set<Index3> different(map.source.begin(), map.source.end());
        return double(different.size()) / double(map.source.size());
    };
    const BlockSynthesisResult optimized = optimizeTexture({exemplar}, options),
                               raster = synthesizeBlocks({exemplar}, options);
    CHECK(optimized.stats.meanCost < 0.9 * raster.stats.meanCost);
    CHECK(places(optimized.map) > 0.3);
    CHECK(optimized.field.box().size() == Index3{80, 80, 48});
    for (float value : test::samplesOf(optimized.field)) REQUIRE((value >= -6.f && value <= 6.f));
    // The field is what the map votes, so a saved map gives it again.
    CHECK(test::samplesOf(voteThroughMap(optimized.map, {exemplar})) == test::samplesOf(optimized.field));
}

TEST_CASE("optimizeTexture: an axis at its own length keeps its source coordinate", "[synth][property]") {
    const auto exemplar = shared(test::ballsField({32, 32, 24}, 3, 6.f, 14));
    BlockSynthesisOptions options = optionsFor({64, 48, 24}, 8, 2);
    const PatchMap map = optimizeTexture({exemplar}, options).map;
    bool moved = false;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        REQUIRE(map.source[i].z == map.originOf(map.place(i)).z);
        moved = moved || map.source[i].x != map.originOf(map.place(i)).x;
    }
    CHECK(moved);
    options.drift = 3;
    const PatchMap drifting = optimizeTexture({exemplar}, options).map;
    for (std::size_t i = 0; i < drifting.source.size(); ++i)
        CHECK(std::abs(drifting.source[i].z - drifting.originOf(drifting.place(i)).z) <= 3);
}

TEST_CASE("optimizeTexture: at an object border faces come from the same face", "[synth][property]") {
    const auto exemplar = shared(test::ballsField({48, 40, 32}, 4, 6.f, 20));
    BlockSynthesisOptions options = optionsFor({96, 40, 32}, 8, 2);
    options.border = {Border::Object, Border::Object, Border::Object};
    const PatchMap map = optimizeTexture({exemplar}, options).map;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const int at = map.originOf(map.place(i)).x, source = map.source[i].x;
        if (at < 8)
            REQUIRE(source == at);
        else if (96 - at - map.block < 8)
            REQUIRE(48 - source == 96 - at);
        else
            REQUIRE((source >= 8 && source + map.block <= 40));
    }
}

TEST_CASE("optimizeTexture: a mask keeps sources inside it, two exemplars are both used",
          "[synth][property]") {
    const auto exemplar = shared(test::ballsField({40, 40, 40}, 6, 6.f, 20));
    const BrickField mask =
        test::fieldFrom({40, 40, 40}, [](const Index3& p) { return p.x < 24 ? 1.f : 0.f; });
    BlockSynthesisOptions options = optionsFor({64, 64, 40}, 8, 2);
    options.masks = {&mask};
    const PatchMap inside = optimizeTexture({exemplar}, options).map;
    for (const Index3& source : inside.source) REQUIRE(source.x + inside.block <= 24);
    options.masks.clear();
    const auto other = shared(test::ballsField({40, 40, 40}, 7, 6.f, 20));
    const PatchMap both = optimizeTexture({exemplar, other}, options).map;
    const auto second = std::count(both.exemplar.begin(), both.exemplar.end(), 1);
    CHECK(second > std::ptrdiff_t(both.exemplar.size() / 10));
    CHECK(second < std::ptrdiff_t(both.exemplar.size() * 9 / 10));
}

TEST_CASE("optimizeTexture: each place from the exemplar that is asked for there", "[synth][property]") {
    const auto one = shared(test::ballsField({40, 40, 40}, 6, 6.f, 20)),
               two = shared(test::ballsField({36, 48, 40}, 7, 6.f, 20));
    const BrickField exemplarMap = test::fieldFrom({64, 64, 40}, [](const Index3& p) {
        return p.x + p.y < 64 ? 0.f : p.y < 40 ? 1.f : -1.f;
    });
    BlockSynthesisOptions options = optionsFor({64, 64, 40}, 8, 2);
    options.exemplarMap = &exemplarMap;
    options.grows = std::array<bool, 3>{true, true, false};
    const PatchMap map = optimizeTexture({one, two}, options).map;
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        const Index3 origin = map.originOf(map.place(i)), middle = origin + Index3{3, 3, 3};
        // A cell copies by a patch of 8 that it lies inside: what is asked for in that patch's middle counts.
        const int asked = int(exemplarMap.at(middle));
        bool everywhere = asked >= 0;
        for (const int away : {-2, 2})
            everywhere = everywhere && exemplarMap.inside(middle + Index3{away, away, 0}) == float(asked) &&
                         exemplarMap.inside(middle + Index3{0, away, 0}) == float(asked);
        if (everywhere) REQUIRE(map.exemplar[i] == asked);
        REQUIRE(map.source[i].z == origin.z);
    }
}

TEST_CASE("optimizeTexture: same bits for any number of threads, other seeds differ",
          "[synth][determinism]") {
    const auto exemplar = shared(test::ballsField({32, 32, 32}, 7, 6.f, 14));
    const auto run = [&](int threads, std::uint64_t seed) {
        RunContext ctx;
        ctx.threads = threads;
        ctx.seed = seed;
        return test::samplesOf(optimizeTexture({exemplar}, optionsFor({56, 48, 40}, 8, 2), ctx).field);
    };
    const std::vector<float> one = run(1, 0);
    CHECK(one == run(2, 0));
    CHECK(one == run(8, 0));
    CHECK(one != run(2, 1));
}

TEST_CASE("optimizeTexture: empty, too small, cancelled", "[synth][error][cancel]") {
    const auto code = [](const auto& work) { return test::thrownBy(work).code; };
    CHECK(code([] { optimizeTexture({}, optionsFor({8, 8, 8}, 4, 1)); }) == int(ErrorCode::InvalidOption));
    CHECK(code([] {
              optimizeTexture({shared(test::noiseField({6, 6, 6}, 1))}, optionsFor({12, 12, 12}, 0, 1));
          }) == int(ErrorCode::Unusable));
    // One value throughout: nothing to look for, and no harm.
    const auto flat = shared(BrickField(IndexBox::fromSize({24, 24, 24}), 4.f));
    CHECK(optimizeTexture({flat}, optionsFor({48, 48, 48}, 8, 2)).field.at({40, 3, 9}) == 4.f);
    std::atomic<bool> cancel{false};
    RunContext ctx;
    ctx.cancel = &cancel;
    ctx.onProgress = [&](const Progress& progress) { cancel = progress.done > 0 && progress.total > 1; };
    const auto exemplar = shared(test::ballsField({32, 32, 32}, 7, 6.f, 14));
    CHECK(code([&] {
              optimizeTexture({exemplar}, optionsFor({64, 64, 64}, 8, 2), ctx);
          }) == int(ErrorCode::Cancelled));
}

TEST_CASE("optimizeTexture: a tiling target begins as it ends, with no more of a step there than inside",
          "[synth][property]") {
    const auto exemplar = shared(test::ballsField({40, 40, 40}, 6, 6.f, 20));
    BlockSynthesisOptions options = optionsFor({56 + 32, 48 + 32, 40}, 8, 2);
    options.border = {Border::Tile, Border::Tile, Border::Cut};
    options.around = {16, 16, 0};
    const BlockSynthesisResult result = optimizeTexture({exemplar}, options);
    const BrickField& field = result.field;
    double across = 0, inside = 0;
    for (int y = 16; y < 64; ++y)
        for (int z = 0; z < 40; ++z) {
            // A period apart all is the same, also beyond both ends.
            for (int x = 8; x < 24; ++x) REQUIRE(field.at({x, y, z}) == field.at({x + 56, y, z}));
            across += double(std::abs(field.at({16 + 55, y, z}) - field.at({16, y, z})));
            for (int x = 20; x < 60; ++x)
                inside += double(std::abs(field.at({x, y, z}) - field.at({x + 1, y, z}))) / 40;
        }
    CHECK(across < 1.3 * inside);
    for (int x = 16; x < 72; ++x)
        for (int z = 0; z < 40; ++z) REQUIRE(field.at({x, 12, z}) == field.at({x, 60, z}));
    CHECK(test::contains(test::thrownBy([&] { synthesizeBlocks({exemplar}, options); }).message,
                         "`border` tile"));
}
