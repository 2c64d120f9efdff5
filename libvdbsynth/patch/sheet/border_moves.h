#pragma once
#include "libvdbsynth/math/vec3.h"

#include "libvdbsynth/patch/place_warp.h"

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

/// What a patch's border moves make of its points.
struct BorderWarp {
    std::vector<WarpedPlace> places;  ///< [points]
    bool warped = false, shrunk = false;
    double before = 0, after = 0;  ///< [world] sums over centres of how far both sides are apart
    std::size_t centres = 0;
};

/// @param moves   spread, at most CompactWarp::kMostCentres   @param radius  [world] 0: nothing is warped
/// @param places  [points] of the exemplar   @par Cost    O(places * moves)   @par Repeats yes
BorderWarp warpAtBorders(const BorderMoves& moves, double radius, const std::vector<Vec3d>& places);

}  // namespace vdbsynth
