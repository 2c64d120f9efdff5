#include "libvdbsynth/map/source_map.h"

#include <catch2/catch.hpp>

#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

// A target of 12 x 8 x 8 by blocks of 8 that begin every 4 along x; three blocks.
SourceMap threeBlocks() {
    SourceMap map;
    map.targetBox = map.targetDomain = {{-2, 0, 0}, {13, 7, 7}};
    map.exemplars.resize(2);
    map.exemplars[0].box = {{10, 20, 30}, {29, 39, 49}};
    map.exemplars[1].box = {{0, 0, 0}, {19, 19, 19}};
    map.patches.target = map.targetBox.size();
    map.patches.block = 8;
    map.patches.stride = 4;
    map.patches.allocate();
    map.patches.source = {{0, 1, 2}, {5, 5, 5}, {7, 0, 0}};
    map.patches.exemplar = {0, 1, 0};
    return map;
}

std::string refusal(const SourceMap& map) {
    return test::thrownBy([&] { requireSound(map); }).message;
}

}  // namespace

TEST_CASE("strongestSource: by hand, for blocks and for variants", "[map][oracle]") {
    SourceMap map = threeBlocks();
    REQUIRE(map.patches.source.size() == 3);
    // Voxel -2 is the first of block 0, which begins at (0, 1, 2) of a box that begins at (10, 20, 30).
    const Source first = strongestSource(map, {-2, 3, 3});
    CHECK(first.exemplar == 0);
    CHECK(nearestVoxel(first) == Index3{10, 24, 35});
    // Voxel 6 is in the middle of block 1 (its voxel 4), at the end of block 0 and the beginning of block 2.
    const Source middle = strongestSource(map, {6, 3, 3});
    CHECK(middle.exemplar == 1);
    CHECK(nearestVoxel(middle) == Index3{9, 8, 8});
    map.patches.exemplar = {0, 0, 0};
    map.variants = {{1, {0, 0, kPi / 2}, 1, {20, 20, 20}}};
    // A quarter turn about the middle (9.5, 9.5) of both boxes, back: (x, y) is from (y, 19 - x).
    const Source rotated = strongestSource(map, {-2, 3, 3});
    CHECK(rotated.exemplar == 1);
    CHECK(nearestVoxel(rotated) == Index3{4, 19, 5});
    CHECK(rotated.rotation.z == Approx(kPi / 2));
}

TEST_CASE("strongestSource: a map without blocks and a voxel outside are refused", "[map][error]") {
    const auto code = [](const SourceMap& map, const Index3& voxel) {
        return test::thrownBy([&] { strongestSource(map, voxel); }).code;
    };
    CHECK(code({}, {0, 0, 0}) == int(ErrorCode::InvalidOption));
    CHECK(code(threeBlocks(), {100, 0, 0}) == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { votingSources({}, {0, 0, 0}); }).code == int(ErrorCode::InvalidOption));
    CHECK(test::thrownBy([] { finerMap(threeBlocks(), 0); }).code == int(ErrorCode::InvalidOption));
}

TEST_CASE("votingSources: all blocks over a voxel, by their weights", "[map][oracle]") {
    SourceMap map = threeBlocks();
    const std::vector<Source> sources = votingSources(map, {2, 3, 3});
    // Voxel 4 of block 0, voxel 0 of block 1: tents 3.5 and 0.5, squared.
    REQUIRE(sources.size() == 2);
    CHECK(sources[0].weight / sources[1].weight == Approx(49));
    CHECK(sources[1].exemplar == 1);
    map.patches.vote = PatchVote::First;
    CHECK(votingSources(map, {2, 3, 3}).size() == 1);
}

TEST_CASE("finerMap: boxes are those of the finer voxels, and places stay in the world", "[map][property]") {
    for (int factor : {1, 2, 3, 4}) {
        INFO(factor);
        const IndexBox box{{-5, 2, 0}, {4, 9, 7}}, finer = finerBox(box, factor);
        CHECK(finer.size() == box.size() * factor);
        for (const Index3& voxel : {finer.min, finer.max, Index3{-7, 20, 3}})
            if (finer.contains(voxel)) {
                const Index3 coarse = coarserVoxel(voxel, factor);
                CHECK(box.contains(coarse));
                CHECK(finerBox({coarse, coarse}, factor).contains(voxel));
            }
    }
    CHECK(coarserVoxel({-1, 0, 1}, 2) == Index3{-1, 0, 0});
    CHECK(coarserVoxel({-2, -1, 1}, 3) == Index3{-1, 0, 0});
    SourceMap map = threeBlocks();
    const SourceMap twice = finerMap(map, 2);
    CHECK(twice.exemplars[0].box == finerBox(map.exemplars[0].box, 2));
    CHECK(nearestVoxel(strongestSource(twice, {-4, 6, 6})) == Index3{20, 48, 70});
    map.exemplars[1].box = {{0, 0, 0}, {1 << 28, 9, 9}};
    CHECK(test::thrownBy([&] { finerMap(map, 8); }).code == int(ErrorCode::ShapeMismatch));
}

TEST_CASE("finerSource: continues from the middle of the voxel it lies in", "[map][oracle]") {
    SourceMap map;
    map.method = MapMethod::Analogy;
    map.finer = 3;
    Source source;
    source.position = {10, 20, 30.5};
    source.rotation = {0, 0, float(kPi / 2)};
    map.elements.add({4, 5, 6}, source);
    // Fine voxel (13, 14, 18) is (1, -1, 0) from the middle (12, 15, 18); turned back, (-1, -1, 0).
    const Source fine = finerSource(map, 0, {13, 14, 18});
    CHECK(fine.position.x == Approx(29));
    CHECK(fine.position.y == Approx(59));
    CHECK(fine.position.z == Approx(91.5));
}

TEST_CASE("requireSound: what no run makes is refused", "[map][error]") {
    CHECK(refusal(threeBlocks()).empty());
    SourceMap map = threeBlocks();
    map.patches.exemplar[1] = 2;
    CHECK(test::contains(refusal(map), "an exemplar that it does not have"));
    map = threeBlocks();
    map.patches.source[2] = {25, 0, 0};
    CHECK(test::contains(refusal(map), "outside the exemplar"));
    map = threeBlocks();
    map.patches.weight = {1, 0, 1};
    CHECK(test::contains(refusal(map), "vote weight"));
    map = threeBlocks();
    map.patches.source.pop_back();
    CHECK(test::contains(refusal(map), "too few or too many blocks"));
    map = threeBlocks();
    map.targetDomain = {{0, 0, 0}, {99, 7, 7}};
    CHECK(test::contains(refusal(map), "outside its box"));
    map = threeBlocks();
    map.variants = {{0, {0, 0, 0}, 1, {65536, 65536, 65536}}};
    CHECK(test::contains(refusal(map), "bad variant"));
    map = threeBlocks();
    map.exemplars.clear();
    CHECK(test::contains(refusal(map), "no exemplar"));
    map = SourceMap();
    map.method = MapMethod::Analogy;
    map.exemplars.resize(1);
    map.exemplars[0].box = map.targetBox = {{0, 0, 0}, {9, 9, 9}};
    CHECK(test::contains(refusal(map), "which depths"));
    map.analogy.depths = {{-512, true}, {0, false}};
    CHECK(refusal(map).empty());
    map.elements.add({4, 4, 10}, Source{});
    CHECK(test::contains(refusal(map), "outside its target"));
}
