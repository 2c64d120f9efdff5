#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/quadric.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// The surface at a vertex.
struct VertexSurface {
    Quadric planes;  ///< of the surface around it
    Vec3d normal;    ///< of the plane it lies in; arbitrary if rank is not 1
    int rank = 1;    ///< 1: in a face, 2: on a crease, 3: in a corner
};

/// Restores creases that a mesh cuts off [attene2003, section 3]: an edge between two vertices that lie in
/// faces whose normals differ by more than 20 degrees crosses a crease without a vertex on it. It is split
/// where the planes of its ends meet; a triangle whose three edges cross creases, or whose corners lie on
/// three, gets a vertex in the corner between them. Edges are split for both their faces, so a closed
/// manifold mesh stays one. Quads become triangles.
/// @param surfaces  [vertices], grows with them
/// @param reach     farthest that a new vertex may lie from the edge it splits
/// @return number of vertices added
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t restoreCreases(Mesh& mesh, std::vector<VertexSurface>& surfaces, double reach);

}  // namespace vdbsynth
