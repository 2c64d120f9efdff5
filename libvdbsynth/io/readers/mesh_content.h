#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/polygon.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// What a mesh file holds, before it becomes a Mesh.
struct MeshContent {
    std::vector<Vec3d> points;  ///< as in the file; not finite only where no face uses them
    PolygonList polygons;
    Attributes attributes;  ///< of the points
};

/// A mesh of floats near an origin (geometry/local_points.h); polygons become triangles and quads
/// (geometry/polygon.h). Points without finite coordinates and faces of fewer than three corners are left
/// out, with a note; faces that cross themselves are a warning.
/// @throw Error BadData (a corner out of range or without finite coordinates), EmptyInput (no faces)
/// @par Cost    O(points) and that of appendPolygons   @par Repeats yes
Mesh meshOf(const std::string& path, MeshContent content, const RunContext& ctx);

}  // namespace vdbsynth
