#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Places on a surface as a graph, for fields over it: points, vertices of a mesh, voxels of a shell.
struct SurfaceSites {
    std::vector<Vec3f> point;   ///< [sites] on the surface
    std::vector<Vec3f> normal;  ///< [sites] there, outward, length 1
    /// Of site i: neighbours[begin[i]] to neighbours[begin[i + 1] - 1], on the same side of a possibly thin
    /// wall (normals less than 90 degrees apart), never i itself.
    std::vector<std::uint32_t> begin, neighbours;

    std::size_t size() const { return point.size(); }
    std::size_t degree(std::size_t i) const { return begin[i + 1] - begin[i]; }
};

/// Points as sites: each one's neighbours are the `count` nearest points that face the same way
/// (n_i . n_j > 0) and do not coincide with it, nearest first, equal distances by number. Fewer only where
/// the set has no more. Exact: the same as a linear scan, but that of points whose nearest face the other way
/// only the nearest 16 * count + 64 are looked at.
/// @param points   [n] finite   @param normals  [n] length 1
/// @param count    1..256
/// @throw Error InvalidOption (count), ShapeMismatch (normals of another number), Cancelled
/// @par Cost    O(n log n) for each neighbour, by a kd-tree
/// @par Repeats same bits for any number of threads
SurfaceSites sitesOfPoints(std::vector<Vec3f> points, std::vector<Vec3f> normals, std::size_t count,
                           const RunContext& ctx = {});

/// The mean over all sites of the distance to their first neighbour, the unit of length of texturing
/// [zhang2004, 3.4]; 0 if none has a neighbour. Summed in double in the order of the sites.
double meanNearestDistance(const SurfaceSites& sites);

/// The points' numbers along a Morton curve through their box, so that points near each other get near
/// numbers; coinciding ones by number.
/// @par Cost    O(n log n)   @par Repeats yes
std::vector<std::uint32_t> mortonOrder(const std::vector<Vec3f>& points, const RunContext& ctx = {});

}  // namespace vdbsynth
