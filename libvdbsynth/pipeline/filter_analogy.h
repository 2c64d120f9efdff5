#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <vector>

namespace vdbsynth {

/// Grids of numbers, such as densities, before and after a filter, in the same voxels.
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

/// Does to a grid of numbers what was done to others (analogy/filter_analogy.h). Voxels of the result that
/// differ from its background are active; a fog volume stays one, at least 0. Voxels count, not the world:
/// the target may have other voxels than the pairs.
/// @param target  any class but a level set; its name, class and transform are the result's
/// @throw Error as validate; EmptyInput (no active voxel), BadData (a value that is no number), Unusable (too
/// little to learn from), Memory, Cancelled
/// @par Cost    see makeFilterAnalogy; memory about 20 bytes a voxel of the active box
/// @par Repeats same bits for any number of threads
FilterGridResult makeFilteredGrid(const std::vector<FilterGridPair>& pairs, const FloatGridConstPtr& target,
                                  const FilterAnalogyOptions& options, const RunContext& ctx = {});

/// True if a grid holds numbers that are no distances.
bool isGridOfNumbers(const FloatGridConstPtr& grid);

}  // namespace vdbsynth
