#pragma once
#include "libvdbsynth/points/surface_sites.h"

#include <vector>

namespace vdbsynth {

/// Directions of least curvature, one per site, where they are distinct: the surface's second
/// fundamental form is fitted to the differences of normals over two rings of neighbours; the
/// tensors (|k1| - |k2|)^2 d d^T are averaged over neighbours 20 times, so that strong directions
/// spread into weak regions; signs propagate from the most distinct voxel. 0 where the
/// curvatures differ by little of the mean difference, for directionField to fill; on a ball, where they
/// differ by roundings alone, directions are arbitrary.
/// @par Cost    O(sites)    @par Repeats same bits for any number of threads
std::vector<Vec3f> curvatureDirections(const SurfaceSites& sites, const RunContext& ctx = {});

}  // namespace vdbsynth
