#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/vdb/level_set.h"

#include <vector>

namespace vdbsynth {

/// Each attribute of a mesh's vertices as a grid of its name over the active voxels of a level set: a float
/// grid, or a Vec3s grid for attributes of two (z is 0) or three values. A voxel takes the value at the
/// nearest point of the mesh (barycentric), or of the nearest vertex where no face is near.
/// @param mesh  [world]   @par Cost    as meshDistance (distance/mesh_distance.h)
/// @par Repeats same bits for any number of threads
std::vector<GridPtr> attributesToGrids(const Mesh& mesh, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx = {});
/// The same for points: a voxel blends the three nearest, weighted by the inverse of their squared distances.
std::vector<GridPtr> attributesToGrids(const PointCloud& cloud, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx = {});
/// Scalar grids and grids of 3-vectors sampled at positions [world], relative to an origin, by the grids'
/// names; a vector grid "uv" gives two values. Trilinear over active voxels, the background where none is
/// active. Level sets and grids of other kinds are skipped.
/// @par Repeats same bits for any number of threads
Attributes gridsToAttributes(const std::vector<GridPtr>& grids, const std::vector<Vec3f>& places,
                             const Vec3d& origin, const RunContext& ctx = {});

}  // namespace vdbsynth
