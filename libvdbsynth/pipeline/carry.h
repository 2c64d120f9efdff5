#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// What came with the exemplars, read through a source map: for every grid that one of them carries one of
/// the same kind, name and metadata on the result's band inside its domain; grids of one name and kind become
/// one. A voxel has the value at the source with the largest weight there, or of the nearest active voxel
/// within two voxels of it, else none; vectors that have a direction are rotated with the source. Grids of a
/// source map itself are left out; grids whose kind or transform cannot be read so are left out with a
/// warning. With CarriedValues::Blended the values of floats and vectors are then means over all sources that
/// have a value there; a map of single voxels has but one source each, so there they are copies.
/// @param map     whose exemplars they are, at their resolution
/// @param result  what was made through it
/// @par Cost    O(active voxels of the result), blended times the overlap of blocks
/// @par Repeats same bits for any number of threads
std::vector<GridPtr> carryThroughMap(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                     const openvdb::FloatGrid& result, CarriedValues values,
                                     const RunContext& ctx = {});

/// carryThroughMap for some voxels only. Grids of `into` that are of a carried grid's name and kind are
/// written into.
std::vector<GridPtr> carryToVoxels(const std::vector<MappedVoxel>& voxels,
                                   const std::vector<const LevelSet*>& exemplars,
                                   const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                   const RunContext& ctx = {});

/// True if a model carries something of that name.
bool carries(const LevelSet& model, const std::string& name);
/// Leaves behind what a model carries of other names.
void keepCarriedNames(LevelSet& model, const std::vector<std::string>& names);

}  // namespace vdbsynth
