#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Faces of any number of corners, one after the other, as files list them.
struct PolygonList {
    std::vector<std::uint32_t> corners;  ///< of all polygons, indices into the points
    std::vector<std::uint32_t> sizes;    ///< corners of each polygon

    void add(const std::uint32_t* first, std::size_t count) {
        corners.insert(corners.end(), first, first + count);
        sizes.push_back(std::uint32_t(count));
    }
};

/// Appends polygons to the faces of a mesh: triangles and convex quads as they are, concave quads as the two
/// triangles on both sides of their inner diagonal, convex polygons as the fan of their first corner, others
/// by ear clipping in their plane; folded ones of up to 16 corners as the triangles of least area. Polygons
/// may be concave, touch themselves or hold holes behind a bridge; nearly flat ones are projected along their
/// normal. Orientation stays; triangles of a flat simple polygon
/// have its area together, and its edges, collinear corners included. Polygons of fewer than three corners
/// are ignored.
/// @param points  that the corners refer to; in range and finite where they are used
/// @return number of polygons that cross themselves, or do when seen along their normal: some of their
///         triangles are flipped or overlap, and their vector areas still add up to that of the polygon
/// @par Cost    O(corners) for convex polygons, see EarClipper for others   @par Repeats yes
std::size_t appendPolygons(Mesh& mesh, const PolygonList& polygons, const std::vector<Vec3d>& points);

}  // namespace vdbsynth
