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
    std::vector<Vec3f> points;        ///< [vertices] world space
    std::vector<Triangle> triangles;  ///< [triangles x 3] indices into points
    std::vector<Quad> quads;          ///< [quads x 4] indices into points
    Attributes attributes;            ///< of the vertices

    std::size_t faceCount() const { return triangles.size() + quads.size(); }
};

/// What a mesh is, as `info` prints it and as the doors check it.
struct MeshSummary {
    std::size_t vertices = 0;
    std::size_t faces = 0;
    std::size_t openEdges = 0;         ///< edges of exactly one face
    std::size_t nonManifoldEdges = 0;  ///< edges of more than two faces
    std::size_t misorientedEdges = 0;  ///< edges that both their faces run through in one direction
    double signedVolume = 0;           ///< [world^3] by the divergence theorem about the box's centre
    double area = 0;                   ///< [world^2]
    Vec3d boxMin, boxMax;              ///< [world] of the points that faces use

    bool closedManifold() const {
        return faces > 0 && openEdges == 0 && nonManifoldEdges == 0 && misorientedEdges == 0;
    }
};

/// Appends a convex polygon: three corners as a triangle, four as a quad, more as a fan.
/// Polygons of fewer than three corners are ignored.
void appendPolygon(Mesh& mesh, const std::uint32_t* corners, std::size_t count);

/// All faces as triangles, quads split along their shorter diagonal (the first on a tie).
std::vector<Triangle> triangulated(const Mesh& mesh);

/// @param mesh  indices must be in range
/// @par Cost    O(faces log faces)
/// @par Repeats yes
MeshSummary summarize(const Mesh& mesh);

/// What the edges of a mesh say of it.
enum class EdgeBalance {
    Open,      ///< some edge is run more often in one direction than in the other
    Balanced,  ///< none is, but some edge has more than two faces: sheets touch, or faces are given twice
    Manifold   ///< every edge has two faces that run it in opposite directions
};

/// Faster than summarize. @par Cost    O(faces)
EdgeBalance edgeBalance(const Mesh& mesh);

/// True if the mesh bounds something everywhere, though its sheets may touch or cross.
inline bool isBalanced(const Mesh& mesh) {
    return edgeBalance(mesh) != EdgeBalance::Open;
}

/// Makes vertices with the same coordinates one, in the faces; points stay. @return number of vertices welded
/// @par Cost    O(vertices log vertices)   @par Repeats yes
std::size_t weldVertices(Mesh& mesh);

/// Leaves one of several faces on the same corners, whatever their orientation: double-sided faces become
/// single, faces given twice count once. Quads become triangles; faces that use a corner twice go.
/// @return number of faces left out, the ones without area not counted
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t removeDuplicateFaces(Mesh& mesh);

/// Turns faces so that those that share an edge run the same way and the mesh as a whole looks outward. Each
/// part that hangs together by edges of two faces keeps the side that most of its area had; where there is no
/// clear majority, the side with positive volume. Quads become triangles.
/// @return number of faces turned
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t orientFaces(Mesh& mesh);

/// Splits vertices so that no edge has more than two faces and the faces around a vertex form one fan.
/// At an edge of 2k faces each face is paired with the neighbour that lies across the solid, so sheets
/// that touch come apart instead of crossing; vertices that were split, or that lie on the very same place as
/// another, move `gap` into their own sheet, so that formats without indices (stl) do not weld them again.
/// Positions change nowhere else.
/// @param mesh  closed (every edge has an even number of faces, half in each direction)
/// @param gap   [world], the move of a split vertex, at least 0
/// @return number of vertices added
/// @par Cost    O(faces log faces)   @par Repeats yes
std::size_t separateNonManifold(Mesh& mesh, float gap);

}  // namespace vdbsynth
