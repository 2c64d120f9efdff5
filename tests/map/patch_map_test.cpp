#include "libvdbsynth/map/patch_map.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

PatchMap identityMap(const Index3& target, int block, int stride) {
    PatchMap map;
    map.target = target;
    map.block = block;
    map.stride = stride;
    map.allocate();
    const Index3 n = map.lattice();
    for (int a = 0; a < n.x; ++a)
        for (int b = 0; b < n.y; ++b)
            for (int c = 0; c < n.z; ++c)
                map.source[map.index({a, b, c})] = {map.origin(0, a), map.origin(1, b), map.origin(2, c)};
    return map;
}

}  // namespace

TEST_CASE("PatchMap: blocks cover every voxel and end with the target", "[grid][property]") {
    for (const Index3& target : {Index3{16, 17, 31}, Index3{64, 40, 16}}) {
        const PatchMap map = identityMap(target, 16, 8);
        const Index3 n = map.lattice();
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(map.origin(axis, 0) == 0);
            CHECK(map.origin(axis, n[axis] - 1) + 16 == target[axis]);
            for (int p = 0; p < target[axis]; ++p) {
                int first, last;
                map.covering(axis, p, first, last);
                REQUIRE(first <= last);
                for (int a = 0; a < n[axis]; ++a) {
                    const bool covers = map.origin(axis, a) <= p && p < map.origin(axis, a) + 16;
                    REQUIRE(covers == (a >= first && a <= last));
                }
            }
        }
    }
}

TEST_CASE("voteThroughMap: a map of places to themselves gives the exemplar back", "[grid][property]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({33, 24, 27}, 3, 4.f));
    const BrickField result = voteThroughMap(identityMap({33, 24, 27}, 8, 4), {exemplar});
    const std::vector<float> a = test::samplesOf(*exemplar), b = test::samplesOf(result);
    // To the last bit: whole bricks are copied, the mean of equal samples elsewhere is that sample.
    CHECK(a == b);
}

TEST_CASE("voteThroughMap: where two blocks disagree the weights decide", "[grid][oracle]") {
    // Along z two blocks of 4 at 0 and 2 read 0 and 1: voxel 2 is sample 2 of the first, 0 of the second.
    const auto exemplar = std::make_shared<const BrickField>(
        test::fieldFrom({4, 4, 8}, [](const Index3& p) { return p.z < 4 ? 0.f : 1.f; }));
    PatchMap map = identityMap({4, 4, 6}, 4, 2);
    REQUIRE(map.source.size() == 2);
    map.source[1] = {0, 0, 4};
    const BrickField result = voteThroughMap(map, {exemplar});
    const double w0 = double(voteWeight(4, 2)), w1 = double(voteWeight(4, 0));
    CHECK(result.at({0, 0, 0}) == 0.f);
    CHECK(result.at({1, 1, 2}) == Approx(w1 / (w0 + w1)));
    CHECK(result.at({1, 1, 5}) == 1.f);
    CHECK(strongestBlock(map, {0, 0, 2}) == Index3{0, 0, 0});
    CHECK(strongestBlock(map, {0, 0, 3}) == Index3{0, 0, 1});
}

TEST_CASE("PatchMap: scaled by two it reads a finer exemplar at the same places", "[grid][property]") {
    const PatchMap map = identityMap({16, 17, 20}, 8, 4).scaled(2, {32, 34, 39});
    CHECK(map.block == 16);
    CHECK(map.overhang == Index3{0, 0, 1});
    const auto exemplar = std::make_shared<const BrickField>(test::noiseField({32, 34, 40}, 9));
    const BrickField result = voteThroughMap(map, {exemplar});
    CHECK(result.box().size() == Index3{32, 34, 39});
    CHECK(result.at({31, 33, 38}) == Approx(exemplar->at({31, 33, 38})).margin(1e-6));
    CHECK(test::thrownBy([&] { map.scaled(2, {128, 68, 78}); }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("voteThroughMap: a block's own weight counts, and the first block alone where it should",
          "[grid][oracle]") {
    const auto exemplar = std::make_shared<const BrickField>(
        test::fieldFrom({4, 4, 8}, [](const Index3& p) { return p.z < 4 ? 0.f : 1.f; }));
    PatchMap map = identityMap({4, 4, 6}, 4, 2);
    map.source[1] = {0, 0, 4};
    map.weight = {0.01f, 1.f};
    const double w0 = 0.01f * double(voteWeight(4, 2)), w1 = double(voteWeight(4, 0));
    CHECK(double(voteThroughMap(map, {exemplar}).at({1, 1, 2})) == Approx(w1 / (w0 + w1)));
    CHECK(strongestBlock(map, {0, 0, 2}) == Index3{0, 0, 1});
    map.vote = PatchVote::First;
    const BrickField first = voteThroughMap(map, {exemplar});
    CHECK(first.at({1, 1, 3}) == 0.f);
    CHECK(first.at({1, 1, 4}) == 1.f);
    CHECK(strongestBlock(map, {0, 0, 3}) == Index3{0, 0, 0});
    CHECK(map.place(1) == Index3{0, 0, 1});
}

TEST_CASE("voteThroughMap: dense arrays give the same bits", "[grid][determinism]") {
    const auto exemplar = std::make_shared<const BrickField>(test::ballsField({40, 33, 37}, 3, 4.f, 9));
    PatchMap map = identityMap({64, 50, 41}, 12, 3);
    for (std::size_t i = 0; i < map.source.size(); ++i) {
        Random random(4, i);
        map.source[i] = {int(random.below(29)), int(random.below(22)), int(random.below(26))};
        map.weight.push_back(float(random.uniform(0.01, 1)));
    }
    const std::vector<DenseField> dense{denseField(*exemplar)};
    RunContext one;
    one.threads = 1;
    CHECK(test::samplesOf(voteThroughMap(map, {exemplar})) ==
          test::samplesOf(voteThroughMap(map, {exemplar}, one, &dense)));
}
