#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// How far the surface departs from a plane at every point: v = l0 / (l0 + l1 + l2), l0 <= l1 <= l2 the
/// eigenvalues of the covariance of the point and its nearest neighbours [pauly2002, Eq. 3]. 0 on a plane, at
/// most 1/3.
/// @param points      [n] finite
/// @param normals     [n], or empty; if given, only neighbours within 90 degrees count (close opposite
/// sheets)
/// @param neighbours  3..256
/// @return [n]; 0 where all coincide
/// @throw Error InvalidOption (neighbours), ShapeMismatch (normals of another number), Cancelled
/// @par Cost    O(n log n)   @par Repeats same bits for any number of threads
std::vector<float> surfaceVariation(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals = {},
                                    std::size_t neighbours = 16, const RunContext& ctx = {});

}  // namespace vdbsynth
