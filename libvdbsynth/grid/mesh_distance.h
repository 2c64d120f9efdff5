#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// Unsigned distance [voxels] to a mesh of faces of about a voxel's size, over a box of voxels, clamped to
/// `halfWidth`. Voxels within one voxel of a face start from it; then, round by round, every voxel tries the
/// nearest faces of its 26 neighbours. Distances are exact to the face that is found, which near creases may
/// not be the very nearest: within two voxels of a face it always is but for rounding (tested), farther out
/// the error stays below a tenth of a voxel.
/// @param mesh       in index space; faces much larger than a voxel cost time in proportion to the box around
/// them
/// @param halfWidth  [voxels], 1.5..300
/// @par Cost         O(faces + voxels in bricks near them * halfWidth)
/// @par Repeats      same bits for any number of threads
BrickField meshDistance(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
