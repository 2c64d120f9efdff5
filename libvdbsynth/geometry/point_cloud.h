#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// Points with unit normals that face out of the solid.
struct PointCloud {
    std::vector<Vec3f> points;   ///< [points] world space, relative to `origin`
    std::vector<Vec3f> normals;  ///< [points], or empty
    Attributes attributes;       ///< of the points
    Vec3d origin;  ///< [world] zero, but where coordinates are too large for floats (local_points.h)
};

/// Spacing [world] of every point: the root mean square distance to its 6 nearest, over root 2, which on an
/// even surface is about the distance between neighbours. Infinite where a squared distance exceeds floats.
/// @par Cost    O(points log points)   @par Repeats same bits for any number of threads
std::vector<float> pointSpacing(const PointCloud& cloud, const RunContext& ctx = {});

/// What dropOutliers removed.
struct Outliers {
    std::size_t points = 0;   ///< all of them
    std::size_t groups = 0;   ///< small groups that they were of; single points are not counted
    std::size_t grouped = 0;  ///< points of these groups
};

/// Removes points that coincide with an earlier one, and outliers: those whose spacing is over eight times
/// the median, those over a million times farther out than most, and groups that a gap of eight to sixteen
/// median spacings separates from all others if they have under 100 points and under a hundredth of the
/// largest group's.
/// @par Cost    O(points log points)   @par Repeats same bits for any number of threads
Outliers dropOutliers(PointCloud& cloud, const RunContext& ctx = {});

/// Gives every point a normal: that of the plane through its 16 nearest neighbours, oriented consistently
/// along a minimum spanning tree of the neighbour graph, flattest pairs first, from the highest point of each
/// component, which faces up [hoppe1992, section 3.3].
/// @par Cost    O(points log points)   @par Repeats same bits for any number of threads
void estimateNormals(PointCloud& cloud, const RunContext& ctx = {});

}  // namespace vdbsynth
