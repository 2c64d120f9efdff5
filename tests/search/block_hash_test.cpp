#include "libvdbsynth/search/block_hash.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

#include <atomic>
#include <map>
#include <set>

using namespace vdbsynth;

namespace {

BlockIndexData dataOf(const BrickField& field, int block, const BrickField* mask = nullptr) {
    BlockIndexOptions options;
    options.block = block;
    options.mask = mask;
    return buildBlockIndexData(std::make_shared<const BrickField>(field), options, {});
}

std::vector<float> blockAt(const BrickField& field, const Index3& corner, int block) {
    std::vector<float> samples(latticeCount({block, block, block}));
    field.readBox(corner, {block, block, block}, samples.data());
    for (float& sample : samples) sample += 0.f;  // -0 becomes +0, which it equals
    return samples;
}

// The hash of every position, by its number; each may be in one run only.
std::map<std::uint64_t, std::uint64_t> hashesOf(const std::vector<Hashed>& all) {
    std::map<std::uint64_t, std::uint64_t> hashes;
    for (const Hashed& each : all)
        for (std::uint32_t i = 0; i < each.run.length; ++i)
            REQUIRE(hashes.emplace(each.run.first + i, each.hash).second);
    return hashes;
}

// Some constant bricks, a voxel that is not in one of them, and blocks across regions that are hashed apart.
BrickField mixedField(const Index3& size) {
    BrickField field = test::ballsField(size, 5, 1.f, 2);
    const float odd = 0.5f;
    field.writeBox(size - Index3{1, 1, 1}, {1, 1, 1}, &odd);
    return field;
}

}  // namespace

TEST_CASE("hashBlocks: blocks have one hash exactly if their samples are equal", "[search][oracle]") {
    const std::vector<std::pair<BrickField, int>> cases{
        {mixedField({20, 18, 46}), 5},
        {test::periodicField({19, 17, 40}, 4), 6},
        {test::noiseField({12, 12, 12}, 1), 4},
        {test::fieldFrom({12, 12, 16}, [](const Index3& p) { return p.z % 2 ? -0.f : 0.f; }), 4}};
    for (const auto& [field, block] : cases) {
        const BlockIndexData data = dataOf(field, block);
        const std::map<std::uint64_t, std::uint64_t> hashes = hashesOf(hashBlocks(data, {}));
        REQUIRE(hashes.size() == latticeCount(data.positions.size()));
        std::map<std::vector<float>, std::uint64_t> known;
        std::set<std::uint64_t> distinct;
        for (const auto& [number, hash] : hashes) {
            const auto found = known.emplace(blockAt(field, data.positionOf(number), block), hash).first;
            REQUIRE(found->second == hash);
            distinct.insert(hash);
        }
        CHECK(distinct.size() == known.size());
    }
}

TEST_CASE("hashBlocks: a run is of constant blocks in one row along z", "[search][property]") {
    const BrickField field = mixedField({24, 20, 60});
    const BlockIndexData data = dataOf(field, 4);
    std::size_t runs = 0;
    for (const Hashed& each : hashBlocks(data, {})) {
        REQUIRE(each.run.length >= 1);
        if (each.run.length == 1) continue;
        ++runs;
        const Index3 first = data.positionOf(each.run.first),
                     last = data.positionOf(each.run.first + each.run.length - 1);
        REQUIRE((first.x == last.x && first.y == last.y));
        const float value = field.at(first);
        for (std::uint32_t i = 0; i < each.run.length; ++i)
            REQUIRE(blockAt(field, first + Index3{0, 0, int(i)}, 4) == std::vector<float>(64, value));
    }
    CHECK(runs > 0);
}

TEST_CASE("hashBlocks: only blocks inside a mask", "[search][property]") {
    const BrickField field = mixedField({20, 20, 20});
    const BrickField mask =
        test::fieldFrom({20, 20, 20}, [](const Index3& p) { return p.x < 13 && p.z != 10 ? 1.f : 0.f; });
    const BlockIndexData data = dataOf(field, 5, &mask);
    std::size_t expected = 0;
    const auto hashes = hashesOf(hashBlocks(data, {}));
    forEachVoxel(data.positions, [&](const Index3& p) {
        const bool inside = blockInsideMask(mask, p, 5);
        expected += inside;
        REQUIRE(hashes.count(data.numberOf(p)) == std::size_t(inside));
    });
    CHECK(hashes.size() == expected);
    CHECK(expected == 9 * 16 * (6 + 5));
}

TEST_CASE("countVariedGroups: those whose blocks meet the bricks that vary", "[search][oracle]") {
    // One brick of noise; 28, 20 and 41 positions are 7, 5 and 11 groups.
    const Index3 size{32, 24, 45};
    const IndexBox noisy = IndexBox::cube({8, 0, 16}, 8);
    const BrickField field = test::fieldFrom(size, [&](const Index3& p) {
        return noisy.contains(p) ? float(1 + p.x + 10 * p.y + 100 * p.z) : 0.f;
    });
    std::size_t expected = 0;
    forEachVoxel(
        IndexBox::fromSize({28, 20, 41}),
        [&](const Index3& p) {
            expected += !IndexBox::cube(p, 5 + kPositionGroup - 1).intersection(noisy).empty();
        },
        kPositionGroup);
    CHECK(countVariedGroups(dataOf(field, 5), {}) == expected);
    CHECK(countVariedGroups(dataOf(BrickField(IndexBox::fromSize(size), 3.f), 5), {}) == 0);
    CHECK(countVariedGroups(dataOf(test::noiseField(size, 1), 5), {}) == 7 * 5 * 11);
}

TEST_CASE("hashBlocks: the same for any number of threads, cancelled when asked, one block of all there is",
          "[search][determinism][cancel][degenerate]") {
    const BlockIndexData data = dataOf(mixedField({40, 36, 44}), 6);
    RunContext one, four, stopped;
    one.threads = 1;
    four.threads = 4;
    const std::vector<Hashed> a = hashBlocks(data, one), b = hashBlocks(data, four);
    CHECK(std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Hashed& x, const Hashed& y) {
        return x.hash == y.hash && x.run.first == y.run.first && x.run.length == y.run.length;
    }));
    CHECK(countVariedGroups(data, one) == countVariedGroups(data, four));
    std::atomic<bool> cancel{true};
    stopped.cancel = &cancel;
    CHECK(test::thrownBy([&] { hashBlocks(data, stopped); }).code == int(ErrorCode::Cancelled));
    CHECK(test::thrownBy([&] { countVariedGroups(data, stopped); }).code == int(ErrorCode::Cancelled));
    const std::vector<Hashed> whole = hashBlocks(dataOf(test::noiseField({7, 7, 7}, 1), 7), {});
    REQUIRE(whole.size() == 1);
    CHECK((whole[0].run.first == 0 && whole[0].run.length == 1));
}
