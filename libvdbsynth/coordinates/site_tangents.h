#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/surface_sites.h"

#include <vector>

namespace vdbsynth {

/// True if a direction is given anywhere.
bool anyDirection(const std::vector<Vec3f>& directions);

/// Tangents for sites, the direction of +u: those given, the rest to follow them, or the smoothest field
/// where none is. Beyond 20 000 sites they are found on sites merged to about a quarter, and read between
/// them.
/// @param directions     [sites] 0 where none is given; empty: none
/// @param spacing        [world] between sites, above 0
/// @param singularities  set to one position in each region without a continuous direction; null: not wanted
/// @throw Error Unusable (directions only along normals), Cancelled
/// @par Repeats same bits for any number of threads
std::vector<Vec3f> siteTangents(const SurfaceSites& sites, const std::vector<Vec3f>& directions,
                                double spacing, std::vector<Vec3f>* singularities = nullptr,
                                const RunContext& ctx = {});

}  // namespace vdbsynth
