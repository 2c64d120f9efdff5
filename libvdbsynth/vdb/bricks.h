#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

/// Copies the values of a grid inside `box` into a field whose box starts at 0, each times `scale` and
/// clamped to [-limit, limit].
/// @param scale  1 / voxel size makes distances [voxels]
/// @par Cost     time O(bricks), memory O(bricks that are not constant)
/// @par Repeats  same bits for any number of threads
BrickField gatherBricks(const openvdb::FloatGrid& grid, const IndexBox& box, float scale, float limit,
                        const RunContext& ctx = {});

/// Turns a field into a grid: voxels with |value| < limit are active, the rest is -limit or +limit
/// (times `scale`), inactive. Outside the field's box everything is +limit.
/// @param corner  index of the grid's voxel for the field's voxel 0
FloatGridPtr scatterBricks(const BrickField& field, const Index3& corner, float scale, float limit,
                           const RunContext& ctx = {});

}  // namespace vdbsynth
