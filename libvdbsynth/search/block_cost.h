#pragma once
#include "libvdbsynth/grid/dense_field.h"

#include <cstdint>

namespace vdbsynth {

/// The one cost of pairing two blocks [lagae2004, Eq. 1], over the known samples only:
///     dist(B, Q) = 1/n * sum over known (i,j,k) of (B[i,j,k] - Q[i,j,k])^2,   n = number of known samples.
/// Differences are floats, squares and sums doubles, added in an order that depends only on the block's size;
/// the search's final ranking and the linear oracle both use this function.
/// @param exemplar  box begins at 0   @param corner  block's minimum corner; the block lies inside
/// @param block     N, side of the block [voxels]
/// @param query     Q, [N x N x N], z fastest
/// @param known     [N x N x N] nonzero where Q counts; null: everywhere
/// @param count     n, at least 1
/// @param giveUp    once the cost is certain to exceed this, some larger value may be returned instead
double blockCost(const BrickField& exemplar, const Index3& corner, int block, const float* query,
                 const std::uint8_t* known, std::int64_t count, double giveUp);

/// The same cost, bit for bit, from an exemplar in one array.
double blockCost(const DenseField& exemplar, const Index3& corner, int block, const float* query,
                 const std::uint8_t* known, std::int64_t count, double giveUp);

/// Number of known samples.
std::int64_t countKnown(const std::uint8_t* known, int block);

}  // namespace vdbsynth
