#pragma once
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/points/surface_sites.h"

#include <vector>

namespace vdbsynth {

/// The cube of side `cell` that a point lies in; far outliers share the outermost cubes. @param cell  above 0
Index3 cellOf(const Vec3f& point, double cell);

/// Sites merged into fewer, each the mean of those near each other.
struct CoarserSites {
    std::vector<Vec3f> point, normal;   ///< [coarser] means of the members; normals of length 1
    std::vector<std::uint32_t> parent;  ///< [finer] number of the coarser site that each belongs to
};

/// Merges the sites in every cube of side `cell` that face the same way as the first of them (normals less
/// than 90 degrees apart), so that the two sides of a thin wall stay apart and the result is evenly dense
/// whatever the input is. Numbered along a Morton curve.
/// @param cell  [world] above 0
/// @par Cost    O(n log n)   @par Repeats same bits for any number of threads
CoarserSites mergedByCells(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals, double cell,
                           const RunContext& ctx = {});

}  // namespace vdbsynth
