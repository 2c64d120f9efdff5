#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/relief/base_surface.h"

namespace vdbsynth {

/// The surface base + strength * relief: 1 gives the scan again, 0 the base, over 1 exaggerates, below 0
/// inverts. With d the distance to the base and h the height over the foot of x,
///     phi(x) = (d(x) - S h) cos(a),  tan(a) = S times the relief's slope,
/// so that phi is a distance to first order; where the relief folds (relief_layer.h), where a height would
/// miss the scan by over a tenth of a voxel, and for parts of the scan that are farther from the base than
/// its reach, phi is the mix (1 - S) d + S D with the scan's distances D.
/// @return a field over the base's box whose zero level is meant, clamped to -reach..reach
/// @param strength  -100..100
/// @throw Error InvalidOption (strength), Cancelled
/// @par Cost    as reliefLayer over the whole reach, times the strength where that is over 1
/// @par Repeats same bits for any number of threads
BrickField reliefSurface(const BaseSurface& base, double strength, const RunContext& ctx = {});

}  // namespace vdbsynth
