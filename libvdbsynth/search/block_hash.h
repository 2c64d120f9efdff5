#pragma once
#include "libvdbsynth/search/block_index_data.h"

#include <vector>

namespace vdbsynth {

/// Side of the groups of positions that the index works with; 4 measured best of 2, 4, 8 on balls and terrain
/// at 64^3.
inline constexpr int kPositionGroup = 4;

/// Blocks of one hash: a single one, or a run along z of blocks that share one constant value.
struct Hashed {
    std::uint64_t hash;
    PositionRun run;
};

/// Number of groups of positions whose blocks are not all constant; what they cost is most of an index.
std::size_t countVariedGroups(const BlockIndexData& data, const RunContext& ctx);

/// All eligible blocks with a rolling hash of their samples: equal blocks have equal hashes.
/// @par Repeats same bits for any number of threads
std::vector<Hashed> hashBlocks(const BlockIndexData& data, const RunContext& ctx);

}  // namespace vdbsynth
