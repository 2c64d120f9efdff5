#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Layout of a patch's samples: the first one, and the steps to the next plane (x) and the next row (y).
struct PatchView {
    const float* first;
    std::ptrdiff_t plane, row;
};

/// The mean squared difference of a patch of side n and the one at a corner of a field. Once it is certain to
/// exceed `giveUp`, some larger value may be returned; distant planes are compared first, since they exceed
/// it soonest. Eight sums in parallel: the same bits on every processor.
float patchDifference(const PatchView& patch, const DenseField& in, const Index3& corner, int n,
                      float giveUp);

struct RoundCounts {
    std::uint64_t patches = 0, compared = 0;
    double cost = 0;  ///< [voxels^2] mean over all patches
};

/// One round: every patch keeps its source or takes a better one, and updates its weight.
/// @param field  the map's current vote
/// @param round  number, for the random draws and the length of the neighbours' step
RoundCounts improveSources(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                           const RunContext& ctx);

/// Gives the patches that make a run too long (patchesTooMany) the next best
/// source; the others do not change.
/// @return how many; 0: no run is too long
std::size_t shortenRuns(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                        const RunContext& ctx);

}  // namespace vdbsynth
