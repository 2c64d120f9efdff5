#include "libvdbsynth/search/block_search.h"

#include <catch2/catch.hpp>

#include <limits>

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
