#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

// Steps of site_regions.h.
namespace vdbsynth {

/// Two sites that are neighbours, a < b.
struct RegionEdge {
    std::uint32_t a = 0, b = 0;
    float difference = 0;  ///< [radians] weighted angle between the normals
};

/// What regions are made of.
struct RegionGraph {
    const SurfaceSites& sites;
    std::vector<RegionEdge> edges;  ///< by difference, then by number
    std::vector<double> area;       ///< [sites] world^2
    std::vector<double> curvature;  ///< [sites] mean angle [radians] a neighbour's distance away, convex > 0
};

RegionGraph regionGraph(const SurfaceSites& sites, const RunContext& ctx);

/// Merges regions until `count` remain or none are neighbours, and those whose border is weak.
/// @param region  [sites] number of a site of the region, the same for all of it; changed likewise
void mergeRegions(const RegionGraph& graph, std::size_t count, std::vector<std::uint32_t>& region,
                  const RunContext& ctx);

/// Halves the largest regions until there are `count`, or none has two sites. @return how often
std::size_t halveRegions(const RegionGraph& graph, std::size_t count, std::vector<std::uint32_t>& region,
                         const RunContext& ctx);

}  // namespace vdbsynth
