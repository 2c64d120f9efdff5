#pragma once
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// A patch's side of its borders: places of the exemplar and how they must move to the middle.
struct BorderMoves {
    std::vector<Vec3d> centres, moves;  ///< plane space of the exemplar
};

/// The moves whose centres are apart from each other, the first of those near each other: at least `apart`,
/// more where there would be over 192.
/// @param apart  [world] above 0   @par Cost    O(moves)   @par Repeats yes
BorderMoves spreadMoves(const BorderMoves& found, double apart);

}  // namespace vdbsynth
