#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

/// A query block. All pointers are borrowed for the call.
struct BlockQuery {
    const float* samples = nullptr;       ///< [N x N x N], z fastest, in the exemplar's unit
    const std::uint8_t* known = nullptr;  ///< [N x N x N] nonzero where samples count; null: everywhere
    IndexBox candidates;                  ///< allowed minimum corners of the match; empty: anywhere
    std::vector<Index3> hints;            ///< positions to try first; they change the time, never the answer
};

struct BlockMatch {
    Index3 position;  ///< minimum corner of the block in the exemplar
    double cost = 0;  ///< blockCost
};

/// How matches are searched; both ways give the same answers.
enum class BlockSearchWay {
    Planned,     ///< by bounds; by correlation if these leave too many positions
    Bounds,      ///< by bounds alone
    Correlation  ///< all costs at once by the FFT, for any query
};

struct BlockSearchOptions {
    int count = 1;  ///< number of matches, at least 1
    /// 0: exact. Above: an approximate search. It skips everything whose lower bound exceeds the cost found
    /// so far divided by (1 + tolerance)^2, so that the k-th answer's root-mean-square difference is at most
    /// (1 + tolerance) times that of the k-th best block. 0..100
    double tolerance = 0;
    BlockSearchWay way = BlockSearchWay::Planned;
};

/// Counters of a search; the caller sums them over calls.
struct BlockSearchCounts {
    std::uint64_t groups = 0;      ///< groups of positions opened
    std::uint64_t nodes = 0;       ///< bounds computed for single nodes
    std::uint64_t exact = 0;       ///< full costs computed
    std::uint64_t transforms = 0;  ///< queries answered by correlation

    BlockSearchCounts& operator+=(const BlockSearchCounts& more) {
        groups += more.groups;
        nodes += more.nodes;
        exact += more.exact;
        transforms += more.transforms;
        return *this;
    }
};

struct BlockIndexOptions {
    int block = 16;                    ///< N, side of the blocks [voxels], 4..256
    const BrickField* mask = nullptr;  ///< in the exemplar's box; blocks need 1 throughout; null: all
    /// An existing folder that stores indices by content hash for later runs; empty: none. A damaged file is
    /// rebuilt, with a warning.
    std::string cacheFolder;
};

/// @param exemplar  to be searched
/// @throw Error InvalidOption (`block` out of range, null exemplar), ShapeMismatch (a box that does not begin
/// at 0, a mask of another box), BadData (NaN), Unusable (block larger than the exemplar)
void validate(const BlockIndexOptions& options, const BrickField* exemplar);
/// @throw Error InvalidOption (a field out of its range)
void validate(const BlockSearchOptions& options);
/// @param block  the index's
/// @throw Error InvalidOption (null samples), BadData (NaN among known samples)
void validate(const BlockQuery& query, int block);

/// Exact best-match search over all blocks of a sparse field: the search tree of [lagae2004,
/// section 4]. A node's bound is its distance at a level of the block pyramid, never above the
/// distance at a finer one (Eq. 2). Here
///  - the order is not node by node, best first, but level by level: positions that a level leaves are
///    bounded by the next, in cubes of 8^3 positions (block_bound.h), cubes with the least bounds first;
///    before that the best few cubes are followed to the end, so that the limit is low from the beginning;
///  - levels are means over cubes of N/2, N/4 ... samples, any N; under a query's mask only cubes that are
///    entirely known are compared and all others contribute 0, so bounds hold for any mask;
///  - blocks with identical samples are one node (all constant regions of one value are one node);
///  - the parent of partly identical nodes is a group of neighbouring positions with the range of each mean,
///    which bounds all of them at once;
///  - the leaf's cost is blockCost over float samples; bounds include a margin for rounding;
///  - if bounds leave more work than comparing everything at once by the FFT (blocks much larger than the
///    exemplar's features), BlockCorrelation is used instead. The decision counts operations, not time.
class BlockIndex {
public:
    /// @param exemplar  box begins at 0; kept alive and shared
    /// @throw Error as validate, Unusable (no block inside the mask), Memory (by ctx.maxMemory),
    /// Io (cacheFolder), Cancelled
    /// @par Cost    time O(positions whose blocks are not constant * N), memory 14 bytes for each of those
    /// and 4 for each of their means and once more; constant blocks cost 16 bytes per run along z. The first
    /// query that needs the FFT computes its transforms, 16 to 28 bytes per voxel more, and each thread that
    /// uses it up to half of that; not if ctx.maxMemory is too small
    /// @par Repeats same bits for any number of threads
    static BlockIndex build(std::shared_ptr<const BrickField> exemplar, const BlockIndexOptions& options,
                            const RunContext& ctx = {});

    BlockIndex(BlockIndex&&) noexcept;
    BlockIndex& operator=(BlockIndex&&) noexcept;
    ~BlockIndex();

    /// The `count` best blocks, by (cost, x, y, z). Fewer if fewer are eligible; a query without known
    /// samples costs 0 everywhere. May be called from many threads at once.
    /// @throw Error InvalidOption (count under 1, no samples), BadData (NaN among them)
    /// @par Repeats yes; the answer equals matchBlocksLinearly's
    std::vector<BlockMatch> match(const BlockQuery& query, int count = 1,
                                  BlockSearchCounts* counts = nullptr) const;

    /// The same with options: within a tolerance, if one is set.
    /// @throw Error InvalidOption (an option out of its range, no samples), BadData (NaN among them)
    /// @par Repeats yes: hints too change nothing while tolerance is 0; above it they may
    std::vector<BlockMatch> match(const BlockQuery& query, const BlockSearchOptions& options,
                                  BlockSearchCounts* counts = nullptr) const;

    /// match for every query, on all of the context's threads. Consecutive queries share working memory and
    /// pass their answers on as hints, so put similar queries next to each other.
    /// @return answers in the order of the queries
    /// @throw Error InvalidOption, BadData, Cancelled
    /// @par Repeats same bits for any number of threads
    std::vector<std::vector<BlockMatch>> matchAll(const std::vector<BlockQuery>& queries,
                                                  const BlockSearchOptions& options = {},
                                                  const RunContext& ctx = {},
                                                  BlockSearchCounts* counts = nullptr) const;

    int block() const;
    const BrickField& exemplar() const;
    /// Box of all block positions.
    const IndexBox& positions() const;
    /// Of the index, including the transforms once they exist.
    std::size_t memoryBytes() const;
    /// Number of distinct blocks, after identical ones were merged into one node.
    std::size_t nodeCount() const;

private:
    struct Impl;
    explicit BlockIndex(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> mImpl;
};

/// The oracle: the same answer by a linear scan of all positions. @throw Error as BlockIndex
std::vector<BlockMatch> matchBlocksLinearly(const BrickField& exemplar, int block, const BlockQuery& query,
                                            int count = 1, const BrickField* mask = nullptr);

}  // namespace vdbsynth
