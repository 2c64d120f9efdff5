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

/// Appends polygons to the faces of a mesh: triangles and convex quads as they are, others as triangles.
/// Polygons of fewer than three corners are ignored.
/// @param points  that the corners refer to; in range
void appendPolygons(Mesh& mesh, const PolygonList& polygons, const std::vector<Vec3d>& points);

}  // namespace vdbsynth
