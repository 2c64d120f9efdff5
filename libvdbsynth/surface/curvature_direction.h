#pragma once
#include "libvdbsynth/surface/surface_shell.h"

#include <vector>

namespace vdbsynth {

/// Directions of least curvature, one a shell voxel, where they are clear: the surface's second fundamental
/// form is fitted to how normals differ over two rings of neighbours; the tensors (|k1| - |k2|)^2 d d^T are
/// averaged over neighbours 20 times, so that strong directions reach into weak places; signs go outward from
/// the clearest place. 0 where both curvatures are alike, for directionField to fill.
/// @par Cost    O(voxels)    @par Repeats same bits for any number of threads
std::vector<Vec3f> curvatureDirections(const SurfaceShell& shell, const RunContext& ctx = {});

}  // namespace vdbsynth
