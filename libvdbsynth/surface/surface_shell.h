#pragma once
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The voxels next to a zero level, as sites: the point of each is the nearest on the zero level, its
/// neighbours are those of its 26 neighbours that are in the shell and on the same side of a possibly thin
/// wall. [voxels]
struct SurfaceShell : SurfaceSites {
    VoxelTable table;  ///< |distance| <= kShellReach
};

inline constexpr float kShellReach = 0.9f;  ///< two layers of voxels, connected by faces

/// @param distance  to the surface, negative inside, exact for two voxels around
/// @throw Error EmptyInput (no surface in the box)
/// @par Repeats same bits for any number of threads
SurfaceShell surfaceShell(const BrickField& distance, const RunContext& ctx = {});

/// The nearest point on the zero level, by two steps along the gradient of the distance.
Vec3f projectToSurface(const BrickField& distance, const Vec3f& point);

}  // namespace vdbsynth
