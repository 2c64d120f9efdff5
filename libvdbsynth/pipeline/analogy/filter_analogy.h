#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <vector>

namespace vdbsynth {

/// Scalar grids, such as densities, before and after a filter, in the same voxels.
struct FilterGridPair {
    FloatGridConstPtr before, after;
};

/// @throw Error InvalidOption (a field out of its range, no pairs, null grids), Unusable (a target that is a
/// level set, a frustum), ShapeMismatch (a pair's grids have different voxels)
void validate(const FilterAnalogyOptions& options, const std::vector<FilterGridPair>& pairs,
              const FloatGridConstPtr& target);

struct FilterGridResult {
    GridPtr grid;  ///< of floats
    FilterAnalogyStats stats;
};

/// Applies to a scalar grid the filter that other grids show (analogy/filter_analogy.h). Voxels of the result
/// that differ from its background are active; a fog volume stays one, at least 0. The filter works in
/// voxels: the target may have another voxel size than the pairs.
/// @param target  any class but a level set; the result takes its name, class and transform
/// @throw Error as validate; EmptyInput (no active voxel), BadData (NaN or infinite values), Unusable (too
/// few voxels for training), Memory, Cancelled
/// @par Cost    see makeFilterAnalogy; memory about 20 bytes a voxel of the active box
/// @par Repeats same bits for any number of threads
FilterGridResult makeFilteredGrid(const std::vector<FilterGridPair>& pairs, const FloatGridConstPtr& target,
                                  const FilterAnalogyOptions& options, const RunContext& ctx = {});

/// True if a grid holds scalars that are not distances.
bool isGridOfNumbers(const FloatGridConstPtr& grid);

}  // namespace vdbsynth
