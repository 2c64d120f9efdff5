#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/math/index_box.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

// The Minkowski functionals: volume (Occupancy::count), area, integrated mean curvature, Euler
// characteristic [ohser2009, chapter 3].

/// What is assumed beyond a box of voxels.
enum class Beyond {
    Unknown,  ///< the texture continues there: only what is decided inside the box is counted
    Void      ///< nothing: the box holds a whole object
};

/// Euler characteristic of the solid, its voxels as closed cubes (solid neighbours are connected by faces,
/// edges and corners, those of the void by faces only): corners - edges + faces - cubes. Each corner of the
/// voxel lattice contributes its shares: half of an edge, a quarter of a face, an eighth of a cube. With
/// Beyond::Unknown only the corners inside the box are summed, so that the mean over many boxes, divided by
/// `eulerVolume`, is the density without bias.
double eulerCharacteristic(const Occupancy& solid, Beyond beyond);
/// Number of voxel corners that eulerCharacteristic summed over: the divisor for a density.
double eulerVolume(const Index3& size, Beyond beyond);

/// A surface as the contributions of its parts, each at its middle; by cells of kElementCell^3 voxels, so
/// that a box reads only nearby ones.
inline constexpr int kElementCell = 16;
struct SurfaceElements {
    struct Element {
        Vec3f middle;
        float value;
    };
    struct ByCell {
        IndexBox cells;  ///< empty: no elements
        std::vector<Element> elements;
        std::vector<std::size_t> first;  ///< [cells + 1, x slowest] where each cell's begin
    };
    ByCell areas;       ///< [triangles] area
    ByCell curvatures;  ///< [edges] length times half the angle between the normals there
};

/// @param mesh  closed, faces outward; edges with other than two faces contribute no curvature
/// @par Cost    O(faces)   @par Repeats same bits for any number of threads
SurfaceElements surfaceElements(const Mesh& mesh, const RunContext& ctx = {});

struct SurfaceFunctionals {
    double area = 0;           ///< [voxels^2]
    double meanCurvature = 0;  ///< [voxels] integral of the mean curvature (k1 + k2) / 2, convex positive
};

/// Area and integrated mean curvature in a box, the latter as the sum over edges of length times half the
/// angle between the normals [cohensteiner2003, section 3].
/// @param box  in voxel coordinates; includes half a voxel around its voxels' centres
/// @par Cost    O(elements within a cell of the box)   @par Repeats yes
SurfaceFunctionals surfaceFunctionals(const SurfaceElements& elements, const IndexBox& box);

}  // namespace vdbsynth
