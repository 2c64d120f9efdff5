#include "libvdbsynth/synth/synthesis_passes.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/grid/pyramid.h"
#include "tests/support/makers.h"

#include <atomic>

using namespace vdbsynth;

namespace {

std::shared_ptr<const BrickField> noise(const Index3& size) {
    return std::make_shared<const BrickField>(test::noiseField(size, 3));
}

BlockSynthesisOptions sized(const Index3& size) {
    BlockSynthesisOptions options;
    options.size = size;
    return options;
}

SynthesisPass passOf(const Index3& target, int scale = 1) {
    SynthesisPass pass;
    pass.target = target;
    pass.block = 8;
    pass.scale = scale;
    return pass;
}

}  // namespace

TEST_CASE("sourceBox: anywhere along growing axes, within the drift along others", "[synth][oracle]") {
    BlockSynthesisOptions options = sized({64, 32, 20});
    const Index3 exemplar{32, 32, 20};
    CHECK(sourceBox(options, passOf({64, 32, 20}), exemplar, 8, {40, 5, 11}) ==
          IndexBox{{0, 5, 11}, {24, 5, 11}});
    options.drift = 4;
    CHECK(sourceBox(options, passOf({64, 32, 20}), exemplar, 8, {40, 5, 11}) ==
          IndexBox{{0, 1, 7}, {24, 9, 12}});
    // In a coarser pass the drift is fewer voxels.
    CHECK(sourceBox(options, passOf({32, 16, 10}, 2), {16, 16, 10}, 4, {20, 5, 3}) ==
          IndexBox{{0, 3, 1}, {12, 7, 5}});
    options.grows = {true, true, false};
    CHECK(sourceBox(options, passOf({64, 32, 20}), exemplar, 8, {40, 5, 11}) ==
          IndexBox{{0, 0, 7}, {24, 24, 12}});
    const BrickField open(IndexBox::fromSize({64, 32, 20}), 1.f);
    options.open = &open;
    CHECK(sourceBox(options, passOf({64, 32, 20}), exemplar, 8, {40, 5, 11}) ==
          IndexBox{{0, 0, 0}, {24, 24, 12}});
}

TEST_CASE("sourceBox: near an object border the same distance from the same face, elsewhere apart from it",
          "[synth][oracle]") {
    BlockSynthesisOptions options = sized({80, 20, 20});
    options.border[0] = Border::Object;
    const Index3 exemplar{40, 20, 20};
    const auto along = [&](int x) {
        const IndexBox box = sourceBox(options, passOf(options.size), exemplar, 8, {x, 0, 0});
        return std::make_pair(box.min.x, box.max.x);
    };
    CHECK(along(0) == std::make_pair(0, 0));
    CHECK(along(7) == std::make_pair(7, 7));
    CHECK(along(8) == std::make_pair(8, 24));
    CHECK(along(64) == std::make_pair(8, 24));
    CHECK(along(65) == std::make_pair(25, 25));
    CHECK(along(72) == std::make_pair(32, 32));
}

TEST_CASE("sourceBox: blocks inside the exemplar, or none, for any options", "[synth][property]") {
    for (std::uint64_t i = 0; i < 2000; ++i) {
        Random random(5, i);
        const auto below = [&](int n) { return int(random.below(std::uint32_t(n))); };
        BlockSynthesisOptions options = sized({20 + below(40), 20 + below(40), 20 + below(40)});
        const Index3 exemplar{20 + below(30), 20 + below(30), options.size.z};
        options.drift = below(12);
        for (Border& border : options.border) border = Border(below(2));
        const int side = 4 + below(2);
        const Index3 origin{below(options.size.x - side + 1), below(options.size.y - side + 1),
                            below(options.size.z - side + 1)};
        const IndexBox box = sourceBox(options, passOf(options.size), exemplar, side, origin);
        if (box.empty()) continue;
        REQUIRE(
            IndexBox::fromSize(exemplar).contains({box.min, box.max + Index3{side - 1, side - 1, side - 1}}));
    }
}

TEST_CASE("planPasses: each at half the resolution of the last, with one block", "[synth][oracle]") {
    const auto exemplar = noise({64, 40, 33});
    const std::vector<SynthesisPass> passes = planPasses({exemplar}, sized({128, 80, 33}), 8, 3, {});
    REQUIRE(passes.size() == 3);
    CHECK(passes[0].exemplars[0] == exemplar);
    const Index3 targets[] = {{128, 80, 33}, {64, 40, 17}, {32, 20, 9}};
    for (std::size_t p = 0; p < 3; ++p) {
        CHECK(passes[p].target == targets[p]);
        CHECK(passes[p].scale == 1 << p);
        // At the coarsest the exemplar has 10 voxels along y and 9 along z: half of one, all of the other.
        CHECK(passes[p].block == (p == 2 ? 4 : 8));
        if (p > 0)
            CHECK(test::samplesOf(*passes[p].exemplars[0]) ==
                  test::samplesOf(halved(*passes[p - 1].exemplars[0])));
    }
    CHECK(planPasses({exemplar}, sized({128, 80, 33}), 8, 1, {}).size() == 1);
}

TEST_CASE("planPasses: ends where blocks or periods are too small, with a note if more were asked for",
          "[synth][degenerate]") {
    std::vector<std::string> notes;
    RunContext ctx;
    ctx.onMessage = [&](MessageLevel level, const std::string& text) {
        CHECK(level == MessageLevel::Note);
        notes.push_back(text);
    };
    BlockSynthesisOptions options = sized({64, 64, 64});
    // 24 voxels: blocks of 12, 6, and then 3.
    CHECK(planPasses({noise({24, 24, 24})}, options, 8, 8, ctx).size() == 2);
    // The smallest exemplar decides.
    CHECK(planPasses({noise({64, 64, 64}), noise({24, 24, 24})}, options, 8, 8, ctx).size() == 2);
    CHECK(notes.empty());
    options.levels = 5;
    planPasses({noise({24, 24, 24})}, options, 8, 5, ctx);
    REQUIRE(notes.size() == 1);
    CHECK(test::contains(notes[0], "`levels` 5"));
    CHECK(test::contains(notes[0], "2 levels"));
    options.levels = 0;
    options.border[0] = Border::Tile;
    options.around = {8, 0, 0};
    const auto passes = [&](int x, int around) {
        options.size.x = x;
        options.around.x = around;
        return planPasses({noise({64, 64, 64})}, options, 8, 8, ctx).size();
    };
    CHECK(passes(96, 16) == 4);  // all that blocks allow
    CHECK(passes(92, 16) == 3);
    CHECK(passes(96, 10) == 2);
    CHECK(passes(91, 16) == 1);
}

TEST_CASE("exemplarAt: the number at the pass's voxel, any without a map", "[synth][oracle]") {
    BlockSynthesisOptions options = sized({16, 8, 8});
    CHECK(exemplarAt(options, passOf({16, 8, 8}), {3, 3, 3}) == -1);
    const BrickField numbers = test::fieldFrom({16, 8, 8}, [](const Index3& p) {
        return p.x < 8 ? -1.f : p.y < 4 ? 2.f : 0.f;
    });
    options.exemplarMap = &numbers;
    CHECK(exemplarAt(options, passOf({16, 8, 8}), {7, 0, 0}) == -1);
    CHECK(exemplarAt(options, passOf({16, 8, 8}), {8, 3, 0}) == 2);
    for (const auto& [voxel, number] :
         {std::pair{Index3{3, 0, 0}, -1}, {Index3{4, 1, 0}, 2}, {Index3{4, 2, 3}, 0}, {Index3{7, 3, 3}, 0}})
        CHECK(exemplarAt(options, passOf({8, 4, 4}, 2), voxel) == number);
}

TEST_CASE("masksOf: masks at every scale, null where there is none, cancelled when asked",
          "[synth][oracle][cancel]") {
    BlockSynthesisOptions options = sized({40, 40, 40});
    const BrickField mask =
        test::fieldFrom({20, 20, 20}, [](const Index3& p) { return p.x > 4 ? 1.f : 0.f; });
    options.masks = {nullptr, &mask};
    const std::vector<PassMasks> masks = masksOf(options, 3, {});
    REQUIRE(masks.size() == 3);
    for (std::size_t p = 0; p < 3; ++p) {
        REQUIRE(masks[p].each.size() == 2);
        CHECK(masks[p].each[0] == nullptr);
        REQUIRE(masks[p].each[1]);
        const BrickField& field = *masks[p].each[1];
        CHECK(field.box().size() == Index3{20 >> p, 20 >> p, 20 >> p});
        // A coarse voxel counts if all of it does: from 5, 6 and 8 on.
        const int first = std::vector<int>{5, 3, 2}[p];
        forEachVoxel(field.box(),
                     [&](const Index3& v) { REQUIRE(field.at(v) == (v.x >= first ? 1.f : 0.f)); });
    }
    options.masks.clear();
    for (const PassMasks& pass : masksOf(options, 2, {})) CHECK((pass.each.empty() && pass.held.empty()));
    options.masks = {&mask};
    std::atomic<bool> cancel{true};
    RunContext stopped;
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { masksOf(options, 2, stopped); }).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownBy([&] {
              planPasses({noise({64, 64, 64})}, sized({64, 64, 64}), 8, 2, stopped);
          }).code == int(ErrorCode::Cancelled));
}
