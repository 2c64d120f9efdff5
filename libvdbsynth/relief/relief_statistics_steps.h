#pragma once
#include "libvdbsynth/relief/relief_statistics.h"

namespace vdbsynth {

/// The octaves of a relief in a box.
std::vector<ReliefOctave> reliefOctaves(const BaseSurface& base, const IndexBox& box, const RunContext& ctx);

}  // namespace vdbsynth
