#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/distance/widen_band.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>

namespace vdbsynth {

/// Copies the values of a grid inside `box` into a field whose box starts at 0, each times `scale` and
/// clamped to [-limit, limit].
/// @param scale  1 / voxel size converts to distances [voxels]
/// @par Cost     time O(bricks), memory O(bricks that are not constant)
/// @par Repeats  same bits for any number of threads
BrickField gatherBricks(const openvdb::FloatGrid& grid, const IndexBox& box, float scale, float limit,
                        const RunContext& ctx = {});

/// A field as a grid: voxels with |value| < limit are active, the rest is -limit or +limit (times `scale`),
/// inactive. Outside the field's box everything is +limit.
/// @param corner  index of the grid's voxel for the field's voxel 0
FloatGridPtr scatterBricks(const BrickField& field, const Index3& corner, float scale, float limit,
                           const RunContext& ctx = {});

/// A closed solid's band as a level set, named and classed as one.
/// @param band       [voxels] in index space
/// @param halfWidth  [voxels] where its distances end
/// @param like       gives voxel size and rotation
/// @param what       begins the message @throw Error EmptyInput "WHAT has no surface"
FloatGridPtr levelSetFrom(const BrickField& band, float halfWidth, const openvdb::FloatGrid& like,
                          const std::string& what, const RunContext& ctx = {});
/// The same with a pure scale. @param voxelSize  [world]
FloatGridPtr levelSetFrom(const BrickField& band, float halfWidth, double voxelSize, const std::string& what,
                          const RunContext& ctx = {});

/// The level set over `domain` as distances [voxels], unchanged but clamped to its narrow band, in a field
/// that begins at 0; for fields that are read but not searched.
BrickField gatherNarrowBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain,
                            const RunContext& ctx = {});

/// The same with `reach` voxels around the domain, but not beyond a cut face: the caps of a clipped model are
/// excluded. The input of widenBand (distance/widen_band.h).
KnownBand gatherKnownBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                          int reach, const RunContext& ctx = {});

/// A level set over `domain` with its band widened to `halfWidth` [voxels]: gatherKnownBand, then widenBand.
BrickField gatherWideBand(const openvdb::FloatGrid& levelSet, const IndexBox& domain, const CutFaces& cut,
                          float halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
