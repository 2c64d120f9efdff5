#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// Mean over a Gaussian of standard deviation `sigma` [voxels], along z, y and x in turn: weights
/// exp(-i^2 / (2 sigma^2)) up to 4 sigma, of sum one. Under 0.7 voxels, where those have another variance,
/// three weights (s^2/2, 1 - s^2, s^2/2). Beyond the box the nearest samples continue.
/// @param sigma  0..2000; 0 returns the field
/// @throw Error InvalidOption (sigma), Cancelled
/// @par Cost    O(voxels of bricks that are not constant within 4 sigma * sigma)
/// @par Repeats same bits for any number of threads
BrickField gaussianMean(const BrickField& field, double sigma, const RunContext& ctx = {});

}  // namespace vdbsynth
