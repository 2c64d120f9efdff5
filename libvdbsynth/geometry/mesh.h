#pragma once
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

using Triangle = std::array<std::uint32_t, 3>;
using Quad = std::array<std::uint32_t, 4>;

/// A polygon mesh of triangles and quads. Faces run counter-clockwise seen from outside.
struct Mesh {
    std::vector<Vec3f> points;        ///< [vertices] world space, relative to `origin`
    std::vector<Triangle> triangles;  ///< [triangles x 3] indices into points
    std::vector<Quad> quads;          ///< [quads x 4] indices into points
    Attributes attributes;            ///< of the vertices
    Vec3d origin;  ///< [world] zero, but where coordinates are too large for floats (local_points.h)

    std::size_t faceCount() const { return triangles.size() + quads.size(); }
};

/// Summary of a mesh, for `info` and for input checks.
struct MeshSummary {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t openEdges = 0;         ///< edges of exactly one face
    std::size_t nonManifoldEdges = 0;  ///< edges of more than two faces
    std::size_t misorientedEdges = 0;  ///< edges that both their faces traverse in the same direction
    double signedVolume = 0;           ///< [world^3] by the divergence theorem about the box's centre
    double area = 0;                   ///< [world^2]
    Vec3d boxMin, boxMax;              ///< [world] of the points that faces use, the origin included

    bool closedManifold() const {
        return faces > 0 && openEdges == 0 && nonManifoldEdges == 0 && misorientedEdges == 0;
    }
};

/// All faces as triangles, quads split along their shorter diagonal (the first on a tie).
std::vector<Triangle> triangulated(const Mesh& mesh);

/// @param mesh  indices must be in range
/// @par Cost    O(faces log faces)
/// @par Repeats yes
MeshSummary summarize(const Mesh& mesh);

/// Classification of a mesh by its edges.
enum class EdgeBalance {
    Open,      ///< some edge is traversed more often in one direction than in the other
    Balanced,  ///< none is, but some edge has more than two faces: sheets touch, or faces are duplicated
    Manifold   ///< every edge has two faces that traverse it in opposite directions
};

/// Faster than summarize. @par Cost    O(faces)
EdgeBalance edgeBalance(const Mesh& mesh);

/// True if the mesh encloses a volume everywhere, though its sheets may touch or cross.
inline bool isBalanced(const Mesh& mesh) {
    return edgeBalance(mesh) != EdgeBalance::Open;
}

/// Merges vertices with equal coordinates, in the faces; points stay. @return number of vertices welded
/// @par Cost    O(vertices log vertices)   @par Repeats yes
std::size_t weldVertices(Mesh& mesh);

/// Keeps one of several faces with the same corners, whatever their orientation: double-sided faces become
/// single, duplicate faces count once. Quads become triangles; faces that use a corner twice are removed.
/// @return number of faces removed, without those of zero area
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t removeDuplicateFaces(Mesh& mesh);

/// Flips faces so that neighbours are oriented consistently and the mesh as a whole faces outward. Each part
/// connected by edges of two faces keeps the orientation that most of its area had; without a clear majority
/// it gets the one with positive volume. Quads become triangles.
/// @return number of faces flipped
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t orientFaces(Mesh& mesh);

/// Splits vertices so that no edge has more than two faces and the faces around a vertex form one fan. At an
/// edge of 2k faces each face is paired with its neighbour across the solid, so sheets that touch are
/// separated instead of crossing. Vertices that were split, or that coincide with another, move by `gap` into
/// their own sheet, so that formats without indices (stl) do not weld them again. No other position changes.
/// @param mesh  closed (every edge has an even number of faces, half in each direction)
/// @param gap   [world], displacement of a split vertex, at least 0
/// @return number of vertices added
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t separateNonManifold(Mesh& mesh, float gap);

}  // namespace vdbsynth
