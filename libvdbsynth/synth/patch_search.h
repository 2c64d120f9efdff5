#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Where a patch's samples lie: its first, and the steps to the next plane (x) and the next row (y).
struct PatchView {
    const float* first;
    std::ptrdiff_t plane, row;
};

/// The mean squared difference of a patch of side n and the one at a corner of a field. Once it is sure to
/// exceed `giveUp` some larger value may come back; planes far apart come first, since they tell soonest.
/// Eight sums side by side: the same bits on every processor.
float patchDifference(const PatchView& patch, const DenseField& in, const Index3& corner, int n,
                      float giveUp);

struct RoundCounts {
    std::uint64_t patches = 0, compared = 0;
    double cost = 0;  ///< [voxels^2] mean over all patches
};

/// One round: every patch keeps its source or takes a better one, and its weight.
/// @param field  what the map now votes
/// @param round  number, for the draws and the length of the neighbours' step
RoundCounts improveSources(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                           const RunContext& ctx);

/// Gives the patches that make a run too long (patchesTooMany) the next best source, and leaves all others.
/// @return how many; 0: no run is too long
std::size_t shortenRuns(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                        const RunContext& ctx);

}  // namespace vdbsynth
