#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

/// The zero level of a grid as a closed mesh in index space, faces outward: OpenVDB's volumeToMesh, then
/// two Newton steps along the gradient of the trilinear field for every vertex, each at most half a voxel;
/// with adaptivity eight, as the vertices of merged cells begin farther away.
/// Edges of more than two faces may occur where sheets touch. Empty if the grid has no zero level.
/// @param adaptivity  0..1, see MeshingOptions
Mesh zeroLevelInIndexSpace(const openvdb::FloatGrid& grid, double adaptivity, const RunContext& ctx);

/// The zero level by dual contouring [ju2002]: one vertex in each cell of eight voxels that the level
/// crosses, at the best common point of the surface's planes in and near the cell (geometry/quadric.h), so
/// that edges and corners stay sharp.
///
/// Ju et al. take planes where the surface crosses the cell's edges, with given normals. Here each voxel of
/// the band within two voxels gives one: through the nearest point of the surface, normal to the gradient of
/// its distance. Next to a crease, outside it, nearest points lie on the crease, and their planes contain it
/// too, so all planes agree. Gradients whose length is not one (across a ridge of the distances) are left
/// out. With a source mesh the planes are those of its nearest faces.
/// @param grid    distances; the result is in its index space
/// @param source  the mesh that the level set was made from, in index space; null: none
/// @par Cost    some microseconds per cell   @par Repeats same bits for any number of threads
Mesh sharpZeroLevel(const openvdb::FloatGrid& grid, const Mesh* source, const RunContext& ctx = {});

}  // namespace vdbsynth
