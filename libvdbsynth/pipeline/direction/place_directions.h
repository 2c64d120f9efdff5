#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/direction/direction.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// The unit directions of a source at positions in space [world]; 0 where it has none. Strokes are mixed: of
/// the eight nearest each has the weight (1/d - 1/R)^2 at distance d, R that of the ninth [franke1980].
/// @param middle  of the model, for Around and Radial [world]   @param field  of the options, for messages
/// @throw Error InvalidOption (Automatic: space has no curvature), BadData (a grid of neither vectors nor
/// real scalars), Unusable (no direction at any position), Cancelled
/// @par Cost    O(positions), of strokes O(positions * log strokes)
/// @par Repeats same bits for any number of threads
std::vector<Vec3d> directionsInSpace(const DirectionSource& source, const std::vector<Vec3d>& positions,
                                     const Vec3d& middle, const std::string& field,
                                     const RunContext& ctx = {});

/// For each direction the smallest rotation from one to the other, axis times angle [radians]; 0 where the
/// direction is 0. Half a turn, for which any axis across would do, is about the axis that the other
/// rotations share most (so a field in a plane rotates in that plane), else about the one nearest to z, else
/// x.
/// @param from  [directions] of length 1   @param directions  of length 1 or 0
/// @par Cost    O(directions)    @par Repeats same bits on every processor
std::vector<Vec3d> rotationsBetween(const std::vector<Vec3d>& from, const std::vector<Vec3d>& directions);

}  // namespace vdbsynth
