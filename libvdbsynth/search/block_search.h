#pragma once
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
    /// What a bound must not exceed to be worth following. Equal costs still count: the tie goes by position.
    double limit() const {
        return mMatches.size() < mCount ? std::numeric_limits<double>::infinity() : mMatches.back().cost;
    }
    /// False if the match was not good enough, and so none of the same cost at a later position is.
    bool add(const BlockMatch& match);
    const std::vector<BlockMatch>& matches() const { return mMatches; }

private:
    std::size_t mCount;
    std::vector<BlockMatch> mMatches;
};

/// A node that may still be the best match. Made in place: a pair that is copied right after its halves were
/// written stalls, which was a twelfth of a search.
struct SurvivingNode {
    SurvivingNode() = default;
    SurvivingNode(float b, std::uint32_t n) : bound(b), node(n) {}
    float bound = 0;
    std::uint32_t node = 0;
};

/// What searches write to while they run; kept for the next one, since getting megabytes from the system for
/// every query costs a tenth of it.
struct BlockSearchScratch {
    CubeBounds cube;
    std::vector<std::pair<float, std::uint32_t>> groups;  // bounds and numbers
    std::vector<SurvivingNode> nodes, survivors, before;
};

struct PartialSearch {
    std::vector<BlockMatch> matches;  ///< the best so far; the answer if finished
    bool finished = true;
};

/// The search by bounds, as BlockIndex says it. Gives up where it sees that it will do more than a given
/// amount of work, which does not depend on the machine.
/// @param mostWork  in means compared where many positions are bounded at once, about half an instruction
///                  each. Infinity: never gives up
PartialSearch searchByBounds(const BlockIndexData& data, const BlockQuery& query,
                             const BlockSearchOptions& options, double mostWork, BlockSearchCounts& counts,
                             BlockSearchScratch& scratch);

}  // namespace vdbsynth
