#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

/// Points as OpenVDB points: a grid named "points" with positions (floats within a voxel), normals as `N`
/// where there are any, and the attributes: floats, or vectors of floats for two (z is 0) or three values.
/// @param voxelSize  [world], above 0; a few points a voxel make compact files
/// @throw Error EmptyInput (no points), InvalidOption (voxelSize), Unusable (too many voxels across)
/// @par Repeats same bits for any number of threads
GridPtr pointGrid(const PointCloud& cloud, double voxelSize, const RunContext& ctx = {});

}  // namespace vdbsynth
