#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// Transfers attributes through a source map: each grid of an exemplar gives a grid of the same kind, name
/// and metadata on the result's band inside its domain; grids of one name and kind become one. A voxel takes
/// the value at the source with the largest weight there, or of the nearest active voxel within two voxels of
/// it, else none. Grids that are active beyond their exemplar's band, as densities inside a solid and fog
/// around it are, also give values beyond the result's: every voxel of the domain whose source is active
/// of a map by blocks (others have sources near the surface only). Vectors with a direction
/// are rotated with the source. Grids of a source map itself are left out; grids whose kind or transform is
/// not supported are left out with a warning. With AttributeValues::Blended, floats and vectors are then
/// means over all sources that have a value there; a map of single voxels has one source per voxel, so these
/// are copies.
/// @param map     of these exemplars, at their resolution
/// @param result  made through the map
/// @par Cost    O(active voxels of the result); blended: times the overlap of blocks
/// @par Repeats same bits for any number of threads
std::vector<GridPtr> transferAttributes(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                        const openvdb::FloatGrid& result, AttributeValues values,
                                        const RunContext& ctx = {});

/// transferAttributes for some voxels only. A grid of `into` with an attribute's
/// name and kind is written into.
/// @param within  [voxels] how far from its source a voxel looks for an active one, 0..2
std::vector<GridPtr> transferToVoxels(const std::vector<MappedVoxel>& voxels,
                                      const std::vector<const LevelSet*>& exemplars,
                                      const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                      const RunContext& ctx = {}, int within = 2);

/// The part of transferAttributes beyond the band, of grids that are active there, into the grids that the
/// band's part made. Nothing where no grid is. Fog (floats of the class fog volume) of a synthesis is the
/// mean over all blocks at a voxel, as the surface is, in the band too. @param map  by blocks
std::vector<GridPtr> transferBeyondBand(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                                        const openvdb::FloatGrid& result, std::vector<GridPtr> into,
                                        const RunContext& ctx = {});
/// True if over a hundredth of a grid's active voxels lie where the level set has none.
bool isBeyondBand(const GridPtr& grid, const openvdb::FloatGrid& levelSet);

/// Says which grids beyond their band a map without blocks brings near the surface only.
void noteBandOnly(const std::vector<const LevelSet*>& exemplars, const RunContext& ctx);

/// The grids of a model that stay as a method changes its surface, with those that the method brought: of one
/// name and kind the brought values lie over the model's own, in a copy.
std::vector<GridPtr> laidOver(const std::vector<GridPtr>& own, const std::vector<GridPtr>& brought);

/// True if a model has an attribute of that name.
bool hasAttribute(const LevelSet& model, const std::string& name);
/// Removes a model's attributes with other names.
void keepAttributes(LevelSet& model, const std::vector<std::string>& names);

}  // namespace vdbsynth
