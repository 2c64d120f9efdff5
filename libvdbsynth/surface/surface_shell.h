#pragma once
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The voxels next to a zero level, as a graph for fields over the surface. [voxels]
struct SurfaceShell {
    VoxelTable table;           ///< |distance| <= kShellReach
    std::vector<Vec3f> point;   ///< of each voxel the nearest point on the zero level
    std::vector<Vec3f> normal;  ///< there, outward, length 1
    /// Of voxel i: neighbours[begin[i]] to neighbours[begin[i + 1] - 1], those of its 26 neighbours that are
    /// in the shell and on the same side of a possibly thin wall (normals less than 90 degrees apart).
    std::vector<std::uint32_t> begin, neighbours;

    std::size_t size() const { return table.size(); }
};

inline constexpr float kShellReach = 0.9f;  ///< two layers of voxels, connected by faces

/// @param distance  to the surface, negative inside, exact for two voxels around
/// @throw Error EmptyInput (no surface in the box)
/// @par Repeats same bits for any number of threads
SurfaceShell surfaceShell(const BrickField& distance, const RunContext& ctx = {});

/// The nearest point on the zero level, by two steps along the gradient of the distance.
Vec3f projectToSurface(const BrickField& distance, const Vec3f& point);

}  // namespace vdbsynth
