#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// How often a tangent field turns around every triangle of a mesh: 0 where it is continuous, 1 at a source,
/// a sink or the middle of a vortex, -1 at a saddle. Along an edge the field turns by the angle between the
/// second corner's tangent and the first's, carried over by the smallest rotation of the normals; the index
/// is the sum of the three less what the surface's curvature makes of it [ray2008, section 3]. On a closed
/// mesh the indices sum to the Euler characteristic, where triangles bend by less than half a turn.
/// @param normals, tangents  of the mesh's points, length 1, perpendicular to each other
/// @return [triangles] of triangulated(mesh)
/// @throw Error ShapeMismatch (normals or tangents of another number than points)
/// @par Cost    O(triangles)   @par Repeats yes
std::vector<int> fieldIndices(const Mesh& mesh, const std::vector<Vec3f>& normals,
                              const std::vector<Vec3f>& tangents);

}  // namespace vdbsynth
