#pragma once
#include "libvdbsynth/pipeline/synth.h"

namespace vdbsynth {

/// What came with an exemplar, read through a source map: for every grid of `exemplar.carried` one of the
/// same kind, name and metadata on the result's band inside its domain. A voxel has the value of the
/// exemplar's voxel that had the most say there, or of the nearest active one within two voxels of it, else
/// none. Grids of a source map itself do not come along; grids whose kind or transform cannot be read so are
/// left out with a warning.
/// @param map     whose exemplar it is, at its resolution
/// @param result  what was made through it
/// @par Cost    O(active voxels of the result)   @par Repeats yes
std::vector<GridPtr> carryThroughMap(const SourceMap& map, const LevelSet& exemplar,
                                     const openvdb::FloatGrid& result, const RunContext& ctx = {});

}  // namespace vdbsynth
