#include "libvdbsynth/search/block_sift.h"

#include <catch2/catch.hpp>

#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

constexpr int kBlock = 8;

struct Searched {
    BrickField field;
    const BrickField* mask = nullptr;
    BlockIndexData data;
    BlockCorrelation correlation;

    explicit Searched(const BrickField& of, const BrickField* inside = nullptr)
        : field(of), mask(inside), data(dataOf()), correlation(field, kBlock) {}

    // Both answers, as a linear scan gives them.
    void requireExact(const std::array<SiftedQuery, 2>& queries, int count) const {
        BlockSearchCounts counts;
        BlockCorrelation::Workspace workspace;
        const auto found = searchByCorrelation(data, correlation, queries, count, counts, workspace);
        std::size_t answered = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            if (!queries[i].query) continue;
            ++answered;
            REQUIRE(found[i].finished);
            const auto exact = matchBlocksLinearly(field, kBlock, *queries[i].query, count, mask);
            REQUIRE(found[i].matches.size() == exact.size());
            for (std::size_t m = 0; m < exact.size(); ++m) {
                REQUIRE(found[i].matches[m].cost == exact[m].cost);
                REQUIRE(found[i].matches[m].position == exact[m].position);
            }
        }
        CHECK(counts.transforms == answered);
        CHECK(counts.exact < 300);
    }

private:
    BlockIndexData dataOf() const {
        BlockIndexOptions options;
        options.block = kBlock;
        options.mask = mask;
        return buildBlockIndexData(std::make_shared<const BrickField>(field), options, {});
    }
};

std::vector<std::uint8_t> halfKnown() {
    std::vector<std::uint8_t> known(kBlock * kBlock * kBlock);
    for (std::size_t i = 0; i < known.size(); ++i) known[i] = latticeVoxel(i, {8, 8, 8}).y < 4;
    return known;
}

}  // namespace

TEST_CASE("searchByCorrelation: the answers of a linear scan, for one query and for two",
          "[search][oracle]") {
    const Searched all(test::ballsField({34, 32, 36}, 4, 3.f));
    const std::vector<float> noise = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    const std::vector<float> other = test::samplesOf(test::noiseField({8, 8, 8}, 10));
    const std::vector<std::uint8_t> known = halfKnown();
    BlockQuery first, second;
    first.samples = noise.data();
    second.samples = other.data();
    second.known = known.data();
    all.requireExact({SiftedQuery{&first, {}}, SiftedQuery{}}, 1);
    all.requireExact({SiftedQuery{&first, {}}, SiftedQuery{&second, {}}}, 5);
    second.candidates = {{3, 4, 5}, {20, 11, 6}};
    all.requireExact({SiftedQuery{&second, {}}, SiftedQuery{&first, {}}}, 4);
    second.candidates = IndexBox::cube({100, 0, 0}, 5);  // no position
    all.requireExact({SiftedQuery{&second, {}}, SiftedQuery{&first, {}}}, 4);
}

TEST_CASE("searchByCorrelation: matches found before save work, and never change the answer",
          "[search][property]") {
    const Searched all(test::ballsField({34, 32, 36}, 4, 3.f));
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    BlockQuery query;
    query.samples = samples.data();
    const auto best = matchBlocksLinearly(all.field, kBlock, query, 40);
    for (const auto& before : {std::vector<BlockMatch>{best[0]}, std::vector<BlockMatch>{best[30], best[39]},
                               std::vector<BlockMatch>(best.begin(), best.begin() + 4)})
        all.requireExact({SiftedQuery{&query, before}, SiftedQuery{}}, 4);
}

TEST_CASE("searchByCorrelation: only blocks inside the exemplar's mask", "[search][property]") {
    const BrickField field = test::ballsField({34, 32, 36}, 4, 3.f);
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    BlockQuery query;
    query.samples = samples.data();
    // The best of all is outside it.
    const int best = matchBlocksLinearly(field, kBlock, query).front().position.x;
    const BrickField mask =
        test::fieldFrom({34, 32, 36}, [&](const Index3& p) { return p.x == best + 4 ? 0.f : 1.f; });
    Searched(field, &mask).requireExact({SiftedQuery{&query, {}}, SiftedQuery{}}, 3);
}

TEST_CASE("searchByCorrelation: with too many equal blocks it stays unfinished and keeps what it had",
          "[search][degenerate]") {
    // Over ten thousand blocks are equal: all of them could be the first.
    const Searched constant(BrickField(IndexBox::fromSize({34, 34, 34}), 1.f));
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    BlockQuery query;
    query.samples = samples.data();
    const BlockMatch known = matchBlocksLinearly(constant.field, kBlock, query, 3).back();
    BlockSearchCounts counts;
    BlockCorrelation::Workspace workspace;
    const auto found =
        searchByCorrelation(constant.data, constant.correlation,
                            {SiftedQuery{&query, {known}}, SiftedQuery{}}, 1, counts, workspace);
    CHECK_FALSE(found[0].finished);
    REQUIRE(found[0].matches.size() == 1);
    CHECK(found[0].matches[0].position == known.position);
    CHECK(counts.transforms == 0);
}
