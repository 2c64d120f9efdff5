#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/lattice.h"

#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

struct DenseField;  // grid/dense_field.h

/// Which blocks over a target sample determine its value.
enum class PatchVote {
    Blend,  ///< all: their mean, weighted by voteWeight and each block's weight
    First   ///< the first in raster order: later blocks fill only open samples [lagae2004, section 5.1]
};

/// The result of a block synthesis as a map: for a lattice of overlapping blocks over the target, the
/// exemplar's block that each was matched to. Any grid of the exemplar can be read through it. Block (a, b,
/// c) begins at target voxel (origin(0,a), origin(1,b), origin(2,c)); origins are multiples of the stride,
/// but the last one is moved back so that its block ends with the target.
struct PatchMap {
    Index3 target{0, 0, 0};  ///< size of the target [voxels]
    int block = 16;          ///< N [voxels]
    int stride = 8;          ///< [voxels], 1..N
    Index3 overhang{0, 0,
                    0};  ///< voxels by which the last blocks extend beyond the target (scaled from odd sizes)
    std::vector<Index3>
        source;  ///< [lattice, x slowest, z fastest] minimum corner of the matched block in its exemplar
    std::vector<std::int32_t> exemplar;  ///< [lattice] number of the exemplar
    std::vector<float> weight;           ///< [lattice] over 0, of a block's vote; empty: all equal
    PatchVote vote = PatchVote::Blend;

    /// Number of blocks along each axis.
    Index3 lattice() const;
    int origin(int axis, int a) const;
    std::size_t index(const Index3& l) const {
        const Index3 n = lattice();
        return latticeIndex(l, n);
    }
    /// First and last lattice block that covers target coordinate p of an axis.
    void covering(int axis, int p, int& first, int& last) const;

    /// Lattice position of index i in the arrays.
    Index3 place(std::size_t i) const;
    /// First voxel of a block in the target.
    Index3 originOf(const Index3& l) const { return {origin(0, l.x), origin(1, l.y), origin(2, l.z)}; }

    /// Makes lattice-sized, empty source and exemplar arrays.
    void allocate();
    /// The same map for grids of `factor` times the resolution.
    PatchMap scaled(int factor, const Index3& newTarget) const;
};

/// Weight of sample i of a block in a vote, per axis (the weight in three dimensions is the product): the
/// tent min(i + 1/2, N - i - 1/2) squared. Nowhere zero, largest in the middle.
float voteWeight(int block, int i);
inline constexpr const char* kVoteKernel = "tent^2";

/// Weight of a block at a target voxel that it covers.
float blockWeight(const PatchMap& map, const Index3& block, const Index3& voxel);

/// The block with the largest weight at a target voxel, the lower on a tie.
Index3 strongestBlock(const PatchMap& map, const Index3& voxel);

/// Reads exemplars through a map: every target sample is the mean of the covering blocks' samples, weighted
/// by voteWeight times the block's own weight. Sums are double, in lattice order.
/// @param exemplars  by number; boxes begin at 0
/// @param dense      the same exemplars as dense arrays, if available: the same bits in a third of the time
/// @par Cost    O(target voxels in bricks that are not constant * (block / stride)^3)
/// @par Repeats same bits for any number of threads
BrickField voteThroughMap(const PatchMap& map,
                          const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                          const RunContext& ctx = {}, const std::vector<DenseField>* dense = nullptr);

}  // namespace vdbsynth
