#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <functional>

namespace vdbsynth {

/// Fills the samples of [corner, corner + size), x slowest, z fastest; negative inside. From many threads.
using BoxFill = std::function<void(const Index3& corner, const Index3& size, float* out)>;

/// A field of which only the zero level is valid: bricks at which the sign changes, including their
/// neighbouring samples, hold the values unchanged, so that linear interpolation finds the level between any
/// two samples; all others are -limit or limit.
/// @par Repeats same bits for any number of threads if fill is a pure function of its box
BrickField crossingField(const IndexBox& box, float limit, const RunContext& ctx, const BoxFill& fill);

}  // namespace vdbsynth
