#include "libvdbsynth/synth/block_synthesis.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

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

TEST_CASE("synthesizeBlocks: a periodic exemplar goes on periodically", "[synth][property]") {
    const auto exemplar = shared(test::periodicField({24, 24, 24}, 8));
    for (int levels : {1, 2}) {
        const BlockSynthesisResult result = synthesizeBlocks({exemplar}, optionsFor({48, 40, 24}, 8, levels));
        // A finer pass also compares with the upsampled coarse result, which is never quite right.
        if (levels == 1) CHECK(result.stats.meanCost == 0);
        const BrickField& field = result.field;
        for (int x = 0; x < 40; ++x)
            for (int y = 0; y < 32; ++y)
                for (int z = 0; z < 24; ++z)
                    REQUIRE(field.at({x, y, z}) == Approx(field.at({x + 8, y + 8, z})).margin(1e-6));
    }
}

TEST_CASE("synthesizeBlocks: an axis at its own length keeps its source coordinate", "[synth][property]") {
    const auto exemplar = shared(test::ballsField({32, 32, 24}, 3, 6.f, 14));
    BlockSynthesisOptions options = optionsFor({64, 48, 24}, 8, 2);
    const PatchMap map = synthesizeBlocks({exemplar}, options).map;
    const Index3 n = map.lattice();
    bool moved = false;
    for (int a = 0; a < n.x; ++a)
        for (int b = 0; b < n.y; ++b)
            for (int c = 0; c < n.z; ++c) {
                const Index3 source = map.source[map.index({a, b, c})];
                REQUIRE(source.z == map.origin(2, c));
                moved = moved || source.x != map.origin(0, a);
            }
    CHECK(moved);
    options.drift = 3;
    const PatchMap drifting = synthesizeBlocks({exemplar}, options).map;
    for (int c = 0; c < n.z; ++c)
        CHECK(std::abs(drifting.source[drifting.index({1, 2, c})].z - drifting.origin(2, c)) <= 3);
}

TEST_CASE("synthesizeBlocks: at an object border faces come from the same face, and from nowhere else",
          "[synth][property]") {
    const auto exemplar = shared(test::ballsField({48, 40, 32}, 4, 6.f, 20));
    BlockSynthesisOptions options = optionsFor({96, 40, 32}, 8, 1);
    options.border = {Border::Object, Border::Object, Border::Object};
    const PatchMap map = synthesizeBlocks({exemplar}, options).map;
    const Index3 n = map.lattice();
    for (int a = 0; a < n.x; ++a) {
        const int at = map.origin(0, a);
        const int source = map.source[map.index({a, 1, 1})].x;
        if (at < 8)
            CHECK(source == at);
        else if (96 - at - 8 < 8)
            CHECK(48 - source == 96 - at);
        else
            CHECK((source >= 8 && source + 8 <= 40));
    }
}

TEST_CASE("synthesizeBlocks: every sample lies between the exemplar's extremes", "[synth][property]") {
    const auto exemplar = shared(test::ballsField({32, 32, 32}, 5, 5.f, 14));
    const BlockSynthesisResult result = synthesizeBlocks({exemplar}, optionsFor({50, 47, 33}, 8, 3));
    for (float value : test::samplesOf(result.field)) REQUIRE((value >= -5.f && value <= 5.f));
    CHECK(result.field.box().size() == Index3{50, 47, 33});
}

TEST_CASE("synthesizeBlocks: two exemplars, each block from the one that fits", "[synth][property]") {
    const auto low =
        shared(test::fieldFrom({24, 24, 24}, [](const Index3& p) { return float(p.x % 4) - 4; }));
    const auto high =
        shared(test::fieldFrom({24, 24, 24}, [](const Index3& p) { return float(p.y % 4) + 4; }));
    const BlockSynthesisResult one = synthesizeBlocks({low, high}, optionsFor({40, 40, 40}, 8, 1));
    for (std::int32_t e : one.map.exemplar) CHECK(e == 0);
    const BlockSynthesisResult other = synthesizeBlocks({high, low}, optionsFor({40, 40, 40}, 8, 1));
    for (float value : test::samplesOf(other.field)) REQUIRE(value > 0);
}

TEST_CASE("synthesizeBlocks: same bits for any number of threads, other seeds differ",
          "[synth][determinism]") {
    const auto exemplar = shared(test::ballsField({32, 32, 32}, 7, 6.f, 14));
    const auto run = [&](int threads, std::uint64_t seed) {
        RunContext ctx;
        ctx.threads = threads;
        ctx.seed = seed;
        return test::samplesOf(synthesizeBlocks({exemplar}, optionsFor({56, 48, 40}, 8, 2), ctx).field);
    };
    const std::vector<float> one = run(1, 0);
    CHECK(one == run(2, 0));
    CHECK(one == run(8, 0));
    CHECK(one != run(2, 1));
}

TEST_CASE("synthesizeBlocks: options out of range and exemplars too small are named", "[synth][error]") {
    const auto exemplar = shared(test::noiseField({20, 20, 20}, 1));
    const auto message = [&](const BlockSynthesisOptions& options) {
        return test::thrownBy([&] { synthesizeBlocks({exemplar}, options); });
    };
    CHECK(test::contains(message(optionsFor({40, 40, 40}, 3, 1)).message, "`block` 3"));
    CHECK(test::contains(message(optionsFor({40, 40, 40}, 8, 9)).message, "`levels` 9"));
    CHECK(test::contains(message(optionsFor({10, 40, 40}, 8, 1)).message,
                         "smaller than the exemplar's domain along x (20 voxels)"));
    const test::Thrown larger = message(optionsFor({40, 40, 40}, 24, 1));
    CHECK(larger.code == int(ErrorCode::Unusable));
    CHECK(test::contains(larger.message, "`block` 24: larger than the exemplar"));
    BlockSynthesisOptions object = optionsFor({40, 40, 40}, 8, 1);
    object.border[1] = Border::Object;
    CHECK(test::contains(message(object).message, "four blocks along y"));
    BlockSynthesisOptions drift = optionsFor({40, 40, 40}, 8, 1);
    drift.drift = -1;
    CHECK(test::contains(message(drift).message, "`drift` -1"));
    CHECK(test::thrownBy([] {
              synthesizeBlocks({}, optionsFor({8, 8, 8}, 4, 1));
          }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] {
              synthesizeBlocks({shared(test::noiseField({6, 6, 6}, 1))}, optionsFor({12, 12, 12}, 0, 1));
          }).code == int(ErrorCode::Unusable));
}

TEST_CASE("synthesizeBlocks: cancel leaves nothing", "[synth][cancel]") {
    const auto exemplar = shared(test::noiseField({20, 20, 20}, 1));
    std::atomic<bool> cancel{false};
    RunContext ctx;
    ctx.cancel = &cancel;
    ctx.onProgress = [&](const Progress& progress) { cancel = progress.done > 0 && progress.total > 1; };
    CHECK(test::thrownBy([&] {
              synthesizeBlocks({exemplar}, optionsFor({40, 40, 40}, 8, 1), ctx);
          }).code == int(ErrorCode::Cancelled));
}

TEST_CASE("deriveBlock: at most 16, even, half of the shortest growing axis", "[synth][fast]") {
    BlockSynthesisOptions options;
    options.size = {128, 128, 64};
    CHECK(deriveBlock({64, 64, 64}, options) == 16);
    CHECK(deriveBlock({26, 64, 64}, options) == 12);
    options.size = {128, 128, 10};
    CHECK(deriveBlock({64, 64, 10}, options) == 10);
    options.border[0] = Border::Object;
    CHECK(deriveBlock({41, 64, 10}, options) == 10);
}

TEST_CASE(
    "synthesizeBlocks: the paper's way copies octants of powers of two, each sample from the first block",
    "[synth][property]") {
    const auto exemplar = shared(test::ballsField({32, 32, 32}, 7, 6.f, 14));
    BlockSynthesisOptions options = optionsFor({56, 48, 40}, 8, 2);
    options.paper = true;
    const BlockSynthesisResult result = synthesizeBlocks({exemplar}, options);
    CHECK(result.map.vote == PatchVote::First);
    CHECK(result.map.block == 8);
    for (const Index3& p : {Index3{0, 0, 0}, Index3{13, 20, 31}, Index3{55, 47, 39}}) {
        const Index3 l = strongestBlock(result.map, p);
        for (int axis = 0; axis < 3; ++axis) {
            // No earlier block covers it.
            CHECK(result.map.origin(axis, l[axis]) + 8 > p[axis]);
            CHECK((l[axis] == 0 || result.map.origin(axis, l[axis] - 1) + 8 <= p[axis]));
        }
        CHECK(result.field.at(p) ==
              exemplar->at(result.map.source[result.map.index(l)] + p - result.map.originOf(l)));
    }
    options.block = 12;
    CHECK(test::contains(test::thrownBy([&] { synthesizeBlocks({exemplar}, options); }).message,
                         "a power of two"));
    options.block = 0;
    options.size = {26, 50, 50};
    CHECK(synthesizeBlocks({shared(test::ballsField({26, 26, 26}, 7, 6.f, 14))}, options).map.block == 8);
}
