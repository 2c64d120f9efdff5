#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/measure/measures.h"

#include <optional>

namespace vdbsynth {

/// Distances are from each vertex to the nearest point of the faces around the other mesh's 8 nearest
/// vertices, so both meshes should be about equally fine, as two zero levels are.
/// @param a, b    in one space and unit, with at least one face each
/// @param within  only vertices in that box are used, to exclude the caps of a texture; none: all
/// @return 0 without vertices
/// @par Cost    O(vertices log vertices)   @par Repeats same bits for any number of threads
SurfaceDistance surfaceDistance(const Mesh& a, const Mesh& b, const std::optional<IndexBox>& within = {},
                                const RunContext& ctx = {});

}  // namespace vdbsynth
