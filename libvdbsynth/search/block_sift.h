#pragma once
#include "libvdbsynth/search/block_correlation.h"
#include "libvdbsynth/search/block_search.h"

#include <array>
#include <vector>

namespace vdbsynth {

struct SiftedQuery {
    const BlockQuery* query = nullptr;  ///< knows some sample; null: none
    std::vector<BlockMatch> before;     ///< matches known already
};

/// The search by correlation: it sifts all positions, and those that are not surely dearer than the best are
/// compared by blockCost. A search is not finished where over some thousand positions are left, as where
/// many are equal: there bounds are the better way.
/// @param queries  the second may be none
/// @par Repeats yes; a finished answer equals matchBlocksLinearly's
std::array<PartialSearch, 2> searchByCorrelation(const BlockIndexData& data,
                                                 const BlockCorrelation& correlation,
                                                 const std::array<SiftedQuery, 2>& queries, int count,
                                                 BlockSearchCounts& counts,
                                                 BlockCorrelation::Workspace& workspace);

}  // namespace vdbsynth
