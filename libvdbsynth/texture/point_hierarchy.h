#pragma once
#include "libvdbsynth/points/site_levels.h"

namespace vdbsynth {

/// Merges sites in fours [zhang2004, 4.1]: a cluster is a site and its three nearest neighbours that are in
/// no cluster yet, fewer where it has no more; the next one starts at the site with most of its neighbours in
/// clusters (site_queue.h), so that few are left over. A coarser site is the mean of its members; the number
/// of sites falls to about a quarter, and density varies as before.
/// @param sites  with neighbours, numbered so that near ones have near numbers
/// @throw Error Cancelled
/// @par Cost    O(sites * neighbours), on one thread   @par Repeats yes
CoarserSites mergedByFours(const SurfaceSites& sites, const RunContext& ctx = {});

}  // namespace vdbsynth
