#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

/// The zero level of a grid as a closed mesh in index space, faces outward: OpenVDB's volumeToMesh, then
/// two Newton steps along the gradient of the trilinear field for every vertex, each at most half a voxel.
/// Edges of more than two faces may occur where sheets touch. Empty if the grid has no zero level.
/// @param adaptivity  0..1, see MeshingOptions
Mesh zeroLevelInIndexSpace(const openvdb::FloatGrid& grid, double adaptivity, const RunContext& ctx);

}  // namespace vdbsynth
