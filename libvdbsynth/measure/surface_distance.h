#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/measure/measures.h"

#include <optional>

namespace vdbsynth {

/// Distances run from each vertex to the nearest point of the faces around the other mesh's 8 nearest
/// vertices, so meshes should be about as fine as each other, as two zero levels are.
/// @param a, b    in one space and unit, with at least one face each
/// @param within  only vertices in that box count: where caps close a texture, not these; none: all
/// @return 0 where no vertex counts
/// @par Cost    O(vertices log vertices)   @par Repeats same bits for any number of threads
SurfaceDistance surfaceDistance(const Mesh& a, const Mesh& b, const std::optional<IndexBox>& within = {},
                                const RunContext& ctx = {});

}  // namespace vdbsynth
