#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/search/block_index.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

struct MatchOptions {
    int block = 16;          ///< N [voxels], 4..256
    Index3 at;               ///< minimum corner of the query block, in the query's index space
    int count = 1;           ///< K, 1..100000
    double tolerance = 0;    ///< BlockSearchOptions::tolerance; 0: exact
    bool check = false;      ///< with a tolerance: also finds the exact matches, to compare
    std::string indexCache;  ///< BlockIndexOptions::cacheFolder; empty: none
    GridConstPtr mask;       ///< compares samples where it is active, of a solid inside (maskOn); null: all
};

struct MatchResult {
    std::vector<BlockMatch> matches;  ///< positions in the exemplar's index space, best first
    BlockSearchCounts counts;
    std::size_t known = 0;  ///< samples of the query that were compared
    /// With `check`: the root-mean-square difference of the k-th match divided by that of the k-th exact
    /// match, averaged over k (1 where both are 0), and the share of the exact matches that were found.
    double exactnessRatio = 1, recall = 1;
};

/// @throw Error InvalidOption (a field out of its range, null models), ShapeMismatch (other voxels than the
/// exemplar's), EmptyInput (a mask without active voxels), Unusable (block larger than the domain, outside
/// the query's), and what requireModel (vdb/level_set.h) throws
void validate(const MatchOptions& options, const LevelSet& exemplar, const LevelSet& query);

/// The blocks of an exemplar's domain with the smallest differences to one of the query's, exact; distances
/// are compared in voxels, clamped to max(8, N/2). With a tolerance: at most (1 + tolerance)
/// times the smallest difference.
/// @throw Error as validate; Unusable (no known sample), Memory, Io (indexCache), Cancelled
/// @par Repeats same bits for any number of threads
MatchResult matchModel(const LevelSet& exemplar, const LevelSet& query, const MatchOptions& options,
                       const RunContext& ctx = {});

}  // namespace vdbsynth
