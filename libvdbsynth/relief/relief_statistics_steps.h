#pragma once
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/relief/relief_statistics.h"

namespace vdbsynth {

/// The octaves of a relief in a box. @param known  null, or a layer of 1.5 voxels at least
std::vector<ReliefOctave> reliefOctaves(const BaseSurface& base, const IndexBox& box,
                                        const ReliefLayer* known, const RunContext& ctx);

}  // namespace vdbsynth
