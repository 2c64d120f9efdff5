#include "libvdbsynth/search/block_search.h"

#include <catch2/catch.hpp>

#include <limits>

#include "libvdbsynth/search/block_sift.h"
#include "tests/support/makers.h"

using namespace vdbsynth;

namespace {

BlockIndexData dataOf(const BrickField& field, int block) {
    BlockIndexOptions options;
    options.block = block;
    return buildBlockIndexData(std::make_shared<const BrickField>(field), options, {});
}

void requireSame(const std::vector<BlockMatch>& a, const std::vector<BlockMatch>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        REQUIRE(a[i].cost == b[i].cost);
        REQUIRE(a[i].position == b[i].position);
    }
}

}  // namespace

TEST_CASE("BestBlocks: by cost, then by position, and none twice", "[search][fast]") {
    BestBlocks best(2);
    CHECK(best.limit() == std::numeric_limits<double>::infinity());
    CHECK(best.add({{5, 0, 0}, 2.0}));
    CHECK(best.add({{5, 0, 0}, 2.0}));
    CHECK(best.matches().size() == 1);
    CHECK(best.add({{4, 0, 0}, 3.0}));
    CHECK(best.limit() == 3.0);
    CHECK_FALSE(best.add({{6, 0, 0}, 3.0}));
    CHECK(best.add({{3, 0, 0}, 3.0}));
    CHECK(best.matches().back().position == Index3{3, 0, 0});
    CHECK(best.add({{9, 9, 9}, 1.0}));
    CHECK(best.matches().front().position == Index3{9, 9, 9});
    CHECK(best.limit() == 2.0);
}

TEST_CASE("searchByBounds: gives up within the work it may do, with costs that are true",
          "[search][property]") {
    const BrickField field = test::noiseField({40, 36, 44}, 3);
    const BlockIndexData data = dataOf(field, 8);
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    BlockQuery query;
    query.samples = samples.data();
    BlockSearchOptions options;
    options.count = 3;
    BlockSearchScratch scratch;
    const std::vector<BlockMatch> exact = matchBlocksLinearly(field, 8, query, 3);
    BlockSearchCounts all;
    const PartialSearch whole =
        searchByBounds(data, query, options, std::numeric_limits<double>::infinity(), all, scratch);
    CHECK(whole.finished);
    requireSame(whole.matches, exact);
    bool gaveUp = false, finished = false;
    for (double mostWork : {1e3, 1e5, 1e6, 1e8, 1e10}) {
        BlockSearchCounts counts;
        const PartialSearch part = searchByBounds(data, query, options, mostWork, counts, scratch);
        gaveUp = gaveUp || !part.finished;
        finished = finished || part.finished;
        if (part.finished) requireSame(part.matches, exact);
        CHECK(counts.nodes <= all.nodes);
        for (const BlockMatch& match : part.matches) {
            query.candidates = IndexBox{match.position, match.position};
            CHECK(matchBlocksLinearly(field, 8, query).front().cost == match.cost);
            query.candidates = {};
        }
    }
    CHECK(gaveUp);
    CHECK(finished);
}

TEST_CASE("searchByCorrelation: goes on with what is known, finished or not by how much is alike",
          "[search][property]") {
    const BrickField field = test::ballsField({34, 32, 36}, 4, 3.f);
    const BlockIndexData data = dataOf(field, 8);
    const BlockCorrelation correlation(field, 8);
    const std::vector<float> samples = test::samplesOf(test::noiseField({8, 8, 8}, 9));
    BlockQuery first, second;
    first.samples = second.samples = samples.data();
    second.candidates = {{3, 4, 5}, {20, 11, 6}};
    std::array<SiftedQuery, 2> queries{SiftedQuery{&first, matchBlocksLinearly(field, 8, first, 1)},
                                       SiftedQuery{&second, {}}};
    BlockSearchCounts counts;
    BlockCorrelation::Workspace workspace;
    const auto found = searchByCorrelation(data, correlation, queries, 4, counts, workspace);
    CHECK((found[0].finished && found[1].finished));
    requireSame(found[0].matches, matchBlocksLinearly(field, 8, first, 4));
    requireSame(found[1].matches, matchBlocksLinearly(field, 8, second, 4));
    CHECK(counts.transforms == 2);
    CHECK(counts.exact < 200);

    // Over ten thousand blocks are equal: all of them could be the first.
    const BrickField constant(IndexBox::fromSize({34, 34, 34}), 1.f);
    const auto many = searchByCorrelation(dataOf(constant, 8), BlockCorrelation(constant, 8),
                                          {SiftedQuery{&first, {}}, SiftedQuery{}}, 1, counts, workspace);
    CHECK_FALSE(many[0].finished);
    CHECK(counts.transforms == 2);
}
