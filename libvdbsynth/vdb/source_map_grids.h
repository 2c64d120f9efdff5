#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// Kinds of grids that a map is written as.
enum class MapTypes {
    Integer,  ///< Vec3I, Int32, Vec3S and float
    Float  ///< Vec3S and float only, which every reader supports (Debian's Python module refuses files with
           ///< other kinds); exact for coordinates up to 2^24
};

/// The source with the largest weight at every active voxel of a result that a map covers: of a synthesis
/// those inside the target domain, of a fill those inside the hole, of an analogy those that have a source.
/// @par Cost    O(voxels * (block / stride)^3)   @par Repeats same bits for any number of threads
std::vector<MappedVoxel> mappedVoxels(const SourceMap& map, const openvdb::FloatGrid& result,
                                      const RunContext& ctx = {});

/// The source with the largest weight at every voxel of a box that a map by blocks covers, in the band or
/// not, but those active in `except`. @throw Error InvalidOption (a map without blocks)
/// @par Cost    as mappedVoxels; 68 bytes a voxel   @par Repeats same bits for any number of threads
std::vector<MappedVoxel> mappedVoxelsIn(const SourceMap& map, const IndexBox& box,
                                        const openvdb::FloatGrid& except, const RunContext& ctx = {});

/// A map as grids in the result's voxels, on mappedVoxels, for an analogy on all voxels that have a source:
///  - `source` Vec3I: the exemplar's voxel, `exemplar` Int32: its number;
///  - where any is not 0, `source_offset` Vec3S: from that voxel to the copied position [voxels],
///    `source_rotation` Vec3S: rotation vector [radians]; where any is not 1 `source_scale` float;
///  - of a map by blocks, on its lattice (indices are lattice coordinates) `vote_source` Vec3I: the block's
/// position in the exemplar, or in the variant from 0; `vote_weight` float; for several exemplars or
/// variants `vote_exemplar` Int32;
///  - of a fill `source_hole` float: distances to the hole [voxels]; of an analogy with a mask
///    `source_strength` float;
/// with the metadata that readSourceMap needs on `vote_source`, or on `source` of an analogy.
/// @throw Error Unusable (MapTypes::Float and a coordinate beyond 2^24)
std::vector<GridPtr> sourceMapGrids(const SourceMap& map, const openvdb::FloatGrid& result,
                                    const RunContext& ctx = {}, MapTypes types = MapTypes::Integer);

/// The map among the grids of a file. @param path  for messages
/// @throw Error BadData (none, or an inconsistent one)
SourceMap sourceMapFrom(const std::string& path, const std::vector<GridPtr>& grids,
                        const RunContext& ctx = {});

/// The same from a file, which is read once. @throw Error BadData, Io
SourceMap readSourceMap(const std::string& path, const RunContext& ctx = {});

/// `source` and `exemplar` of any map as they are, unchecked against exemplars, for `compare`. Without an
/// `exemplar` grid all are 0.
/// @return empty if the grids have no `source` of a kind that a map has
std::vector<MappedVoxel> strongestSourcesIn(const std::vector<GridPtr>& grids);
/// True if there is a grid `source` whose voxels are aligned with those of `like`.
bool hasSourcesIn(const std::vector<GridPtr>& grids, const openvdb::FloatGrid& like);

/// True for the names of grids that a source map consists of.
bool isOfSourceMap(const std::string& gridName);

}  // namespace vdbsynth
