#pragma once
// The search by bounds, behind BlockIndex::match: begin to read at block_index.h.
#include "libvdbsynth/search/block_bound.h"
#include "libvdbsynth/search/block_index_data.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace vdbsynth {

/// The best matches of a search so far, best first: by cost, then by position.
class BestBlocks {
public:
    explicit BestBlocks(int count) : mCount(std::size_t(count)) {}
    /// The limit for bounds worth following. Equal costs still count: the tie goes by position.
    double limit() const {
        return mMatches.size() < mCount ? std::numeric_limits<double>::infinity() : mMatches.back().cost;
    }
    /// False if the match was not good enough; then none of the same cost at a later position is.
    bool add(const BlockMatch& match);
    const std::vector<BlockMatch>& matches() const { return mMatches; }

private:
    std::size_t mCount;
    std::vector<BlockMatch> mMatches;
};

/// A node that may still be the best match. Constructed in place: copying a pair right after writing its
/// halves stalls, which took a twelfth of a search.
struct SurvivingNode {
    SurvivingNode() = default;
    SurvivingNode(float b, std::uint32_t n) : bound(b), node(n) {}
    float bound = 0;
    std::uint32_t node = 0;
};

/// Working memory of searches; kept for the next one, since allocating megabytes for every query takes a
/// tenth of it.
struct BlockSearchScratch {
    CubeBounds cube;
    std::vector<std::pair<float, std::uint32_t>> groups;  // bounds and numbers
    std::vector<SurvivingNode> nodes, survivors, before;
};

struct PartialSearch {
    std::vector<BlockMatch> matches;  ///< the best so far; the answer if finished
    bool finished = true;
};

/// The search by bounds as described at BlockIndex. It gives up once it expects more than a given amount of
/// work, which does not depend on the machine.
/// @param mostWork  in means compared with many positions bounded at once, about half an instruction each.
/// Infinity: never gives up
PartialSearch searchByBounds(const BlockIndexData& data, const BlockQuery& query,
                             const BlockSearchOptions& options, double mostWork, BlockSearchCounts& counts,
                             BlockSearchScratch& scratch);

}  // namespace vdbsynth
