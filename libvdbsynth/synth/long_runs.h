#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// 1 for every patch that a run has too many of. A run is patches that touch on the lattice and whose sources
/// lie just as they do: together one verbatim piece of an exemplar. Of a run with more than `share` of the
/// exemplar's patches those stay that are nearest to its middle, the others are marked.
/// @param counted  [lattice] 1: the patch holds a surface; others belong to no run
/// @par Cost    O(patches * log(patches))   @par Repeats same bits for any number of threads (uses one)
std::vector<std::uint8_t> patchesTooMany(const PatchLevel& level, const PatchMap& map,
                                         const std::vector<std::uint8_t>& counted, double share);

}  // namespace vdbsynth
