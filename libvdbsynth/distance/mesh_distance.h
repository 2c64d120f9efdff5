#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstdint>
#include <functional>

namespace vdbsynth {

/// Unsigned distance [voxels] to a mesh with faces of about a voxel's size, over a box of voxels, clamped to
/// `halfWidth`. Voxels within one voxel of a face start from it; then, in rounds, every voxel tries the
/// nearest faces of its 26 neighbours. Distances are exact to the face that is found, which near creases may
/// not be the nearest: within two voxels of a face it always is except for rounding (tested), farther out the
/// error stays below a tenth of a voxel.
/// @param mesh       in index space; the cost of faces much larger than a voxel grows with their bounding box
/// @param halfWidth  [voxels], 1.5..300
/// @par Cost         O(faces + voxels in bricks near them * halfWidth)
/// @par Repeats      same bits for any number of threads
BrickField meshDistance(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx = {});

/// No face is within the band.
inline constexpr std::uint32_t kNoFace = 0xffffffffu;

/// Calls visit(corner, faces) for every cube of 8 voxels of the box that the band touches, from many threads:
/// for each voxel, x slowest, the nearest face, an index into triangulated(mesh) (geometry/mesh.h), or
/// kNoFace; of equally near faces the first. Corners are box.min plus multiples of 8; a cube may extend
/// beyond the box.
/// @par Cost    as meshDistance   @par Repeats yes
void forNearestFaces(const Mesh& mesh, const IndexBox& box, float halfWidth, const RunContext& ctx,
                     const std::function<void(const Index3& corner, const std::uint32_t* faces)>& visit);

}  // namespace vdbsynth
