#pragma once
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/relief/relief_layer.h"

namespace vdbsynth {

/// Counts scan and base, and says where they differ.
void compareTopology(ReliefExtraction& result, const RunContext& ctx);

/// The grids of a layer over the base's band.
void makeReliefGrids(ReliefExtraction& result, const ReliefLayer& layer);

}  // namespace vdbsynth
