#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// Numbers before and after something was done to them, over one box. Borrowed.
struct FilterPair {
    const BrickField *before = nullptr, *after = nullptr;
};

struct FilterAnalogyResult {
    BrickField after;
    FilterAnalogyStats stats;
};

/// Learns what was done to numbers from before and after, and does it to others: the naive variant of
/// [bhat2004, section 4.1], neighbourhoods along the grid's axes, for filters such as a blur that have no
/// direction.
/// Beyond the paper, which copies the value of the nearest neighbourhood: the affine map of the neighbourhood
/// that fits best by least squares, which is exact for linear filters within its reach, plus, where that errs
/// less on voxels held out (a quarter, in blocks of 16^3), what the map missed at the nearest row.
/// @param target  anything over any box; outside of boxes values go on as they are at the border
/// @throw Error InvalidOption, ShapeMismatch (a pair over two boxes), BadData (NaN), Unusable (fewer than
/// 1000 voxels to learn from), Cancelled
/// @par Cost    O(voxels that are not constant * samples), and a search each if the rests are used
/// @par Repeats same bits for any number of threads
FilterAnalogyResult makeFilterAnalogy(const std::vector<FilterPair>& pairs, const BrickField& target,
                                      const FilterAnalogyOptions& options, const RunContext& ctx = {});

/// How far from a voxel its neighbourhood goes, smoothing included. [voxels]
int filterReach(const FilterAnalogyOptions& options);

}  // namespace vdbsynth
