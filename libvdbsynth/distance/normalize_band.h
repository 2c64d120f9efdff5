#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// A field with the same zero level whose values are distances to first order, at a fraction of
/// rebuildBand's cost: two steps of the eikonal equation's upwind differences [rouy1992], then no value is
/// longer than its neighbours allow, so that every voxel beside the surface has all of its neighbours in the
/// band, but where the field steps from -limit to limit. For drafts.
/// @param field  [voxels] within [-limit, limit], negative inside
/// @par Cost    O(voxels near the surface)   @par Repeats same bits for any number of threads
BrickField normalizeBand(BrickField field, float limit, const RunContext& ctx = {});

}  // namespace vdbsynth
