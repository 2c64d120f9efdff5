#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Regions of a surface.
struct SiteRegions {
    std::vector<std::int32_t> label;  ///< [sites] 0 to labels - 1, by descending area
    std::size_t labels = 0;           ///< in use; fewer than asked for only if there are fewer sites
    std::size_t found = 0;    ///< regions that creases, curvature or gaps bound, at most as many as asked for
                              ///< unless gaps bound more
    std::size_t halved = 0;   ///< times that a region was halved without such a bound, to get enough labels
    std::size_t islands = 0;  ///< sites of pieces under 1 % of the largest; they take the nearest's label
};

/// A graph for siteRegions: every point's 8 nearest, whichever way they face, so that it connects what a
/// crease of any angle bounds.
SurfaceSites sitesAcrossCreases(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                                const RunContext& ctx = {});

/// Divides a surface into regions by its normals, curvature and connectivity.
///
/// Neighbouring sites differ by the angle between their normals, halved over convex creases, as parts of
/// things meet in concave ones [katz2003, after the minima rule]; over more than the mean distance of
/// neighbours it is divided by the distance. Regions grow over edges in the order of that difference while it
/// is at most the largest inside either region + 0.1 / its sites [felzenszwalb2004, k = 0.1]. Then the pair
/// is merged again and again for which (mean difference along the border + 0.5 * difference of mean
/// curvatures)
/// * sqrt(area of the smaller) / (share of its border that the other takes) is least, until as many regions
/// remain as are asked for. Pairs whose border is not twice as strong as the inside of one of them merge too,
/// and the largest regions are halved instead, along the graph, until there are enough. Pieces that no edge
/// connects are regions of their own; more of those than are asked for are grouped by size, at the largest
/// ratios between one and the next smaller.
/// @param sites  any graph, such as sitesAcrossCreases; neighbours count in both directions
/// @param count  1..4096 regions
/// @throw Error InvalidOption (count), EmptyInput (no sites), Cancelled
/// @par Cost    O(edges log^2 edges)   @par Repeats same bits for any number of threads
SiteRegions siteRegions(const SurfaceSites& sites, std::size_t count, const RunContext& ctx = {});

}  // namespace vdbsynth
