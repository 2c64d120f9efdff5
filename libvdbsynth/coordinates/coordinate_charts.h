#pragma once
#include "libvdbsynth/coordinates/coordinate_level.h"

namespace vdbsynth {

/// Lays charts over the level, whole pieces of the sample: a site at a time is continued from one that has a
/// coordinate, breadth first, as long as that stays inside the sample. Where no chart reaches, the next
/// begins beside those there are, at the node of the sample whose feature fits them best; the very first, and
/// those that nothing adjoins, begin at a random place.
/// @par Cost    O(sites + charts * nodes)   @par Repeats yes; not parallel
void layCharts(CoordinateLevel& level, std::uint32_t number, const RunContext& ctx = {});

}  // namespace vdbsynth
