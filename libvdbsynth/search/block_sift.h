#pragma once
#include "libvdbsynth/search/block_correlation.h"
#include "libvdbsynth/search/block_search.h"

#include <array>
#include <vector>

namespace vdbsynth {

struct SiftedQuery {
    const BlockQuery* query = nullptr;  ///< with at least one known sample; null: none
    std::vector<BlockMatch> before;     ///< matches found already
};

/// The search by correlation: it sifts all positions, and blockCost compares those that may cost less than
/// the best. It stays unfinished if over some thousand positions are left, as with many equal blocks: bounds
/// are faster there.
/// @param queries  the second may be empty
/// @par Repeats yes; a finished answer equals matchBlocksLinearly's
std::array<PartialSearch, 2> searchByCorrelation(const BlockIndexData& data,
                                                 const BlockCorrelation& correlation,
                                                 const std::array<SiftedQuery, 2>& queries, int count,
                                                 BlockSearchCounts& counts,
                                                 BlockCorrelation::Workspace& workspace);

}  // namespace vdbsynth
