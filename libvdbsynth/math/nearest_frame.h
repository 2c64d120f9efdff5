#pragma once
#include "libvdbsynth/math/vec3.h"

#include <array>

namespace vdbsynth {

/// The unit directions at right angles to each other that are nearest to three given ones (polar
/// decomposition, Newton's iteration [higham1986]); a reflection stays one.
/// @param axes  not in one plane   @par Repeats yes
std::array<Vec3d, 3> nearestFrame(const std::array<Vec3d, 3>& axes);

}  // namespace vdbsynth
