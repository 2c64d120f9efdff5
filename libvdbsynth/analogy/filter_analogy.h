#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// A scalar field before and after a filter, over one box. Borrowed.
struct FilterPair {
    const BrickField *before = nullptr, *after = nullptr;
};

struct FilterAnalogyResult {
    BrickField after;
    FilterAnalogyStats stats;
};

/// Learns a filter from fields before and after, and applies it to others: the naive variant of [bhat2004,
/// section 4.1], axis-aligned neighbourhoods, for filters such as a blur that have no direction. Beyond the
/// paper, which copies the value of the nearest neighbourhood: the affine map of the neighbourhood that fits
/// best by least squares, which is exact for linear filters within its reach, plus the map's residual at the
/// nearest row where that lowers the error on held-out voxels (a quarter, in blocks of 16^3).
/// @param target  any values over any box; outside boxes the border values continue
/// @throw Error InvalidOption, ShapeMismatch (a pair over two boxes), BadData (NaN), Unusable (fewer than
/// 1000 voxels for training), Cancelled
/// @par Cost    O(voxels that are not constant * samples), and a search for each if the residuals are used
/// @par Repeats same bits for any number of threads
FilterAnalogyResult makeFilterAnalogy(const std::vector<FilterPair>& pairs, const BrickField& target,
                                      const FilterAnalogyOptions& options, const RunContext& ctx = {});

/// Reach of a neighbourhood around a voxel, smoothing included. [voxels]
int filterReach(const FilterAnalogyOptions& options);

}  // namespace vdbsynth
