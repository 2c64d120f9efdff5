#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

/// Gives a result that was edited in places the voxels of its target back, bit for bit, wherever no change is
/// near: values and active states of leaves. A voxel next to a change keeps what the edit made of it, as its
/// distance is that to the new surface.
/// @param target     what was edited, of the same transform and half-width as `result`
/// @param before     the target's distances [voxels], in a box that `corner` places in index space
/// @param after      the edited distances, over the same box
/// @param limit      [voxels] distances farther from the surface count as equal
/// @param halfWidth  [voxels] of the bands: how far a change reaches
/// @return the share of the result's active voxels that are the target's own
/// @throw Error Cancelled
/// @par Cost    O(voxels of the box that are not constant)   @par Repeats same bits for any number of threads
double keepUnchanged(const openvdb::FloatGrid& target, const BrickField& before, const BrickField& after,
                     const Index3& corner, float limit, float halfWidth, openvdb::FloatGrid& result,
                     const RunContext& ctx = {});

}  // namespace vdbsynth
