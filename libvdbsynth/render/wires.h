#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/render/camera.h"

#include <vector>

namespace vdbsynth {

/// How much of each pixel the edges of a mesh's faces cover, 0..1: lines a 700th of the picture's height
/// wide, at least one pixel, with soft sides. Hidden edges and those behind the camera are left out.
/// @param mesh    [world]
/// @param depths  [height x width, world] of what hides edges, along the camera's direction
/// @param slack   [world] an edge this far behind is still drawn
/// @return [height x width]
/// @par Cost O(pixels that edges pass)   @par Repeats yes
std::vector<float> wireCoverage(const Mesh& mesh, const Camera& camera, int width, int height,
                                const std::vector<float>& depths, double slack);

}  // namespace vdbsynth
