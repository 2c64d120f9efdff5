#pragma once
#include "libvdbsynth/search/block_index_data.h"

#include <vector>

namespace vdbsynth {

/// Side of the index's groups of positions; of 2, 4 and 8, 4 was fastest on balls and terrain at 64^3.
inline constexpr int kPositionGroup = 4;

/// Blocks of one hash: a single one, or a run along z of blocks that share one constant value.
struct Hashed {
    std::uint64_t hash;
    PositionRun run;
};

/// Number of groups of positions whose blocks are not all constant; they account for most of an index's cost.
std::size_t countVariedGroups(const BlockIndexData& data, const RunContext& ctx);

/// All eligible blocks with a rolling hash of their samples: equal blocks have equal hashes.
/// @par Repeats same bits for any number of threads
std::vector<Hashed> hashBlocks(const BlockIndexData& data, const RunContext& ctx);

}  // namespace vdbsynth
