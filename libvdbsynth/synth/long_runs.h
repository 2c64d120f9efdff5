#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Marks with 1 the patches in runs longer than the limit. A run is a set of patches that touch on
/// the lattice and whose sources have the same offsets: together one verbatim piece of an exemplar.
/// Of a run with more than `share` of the exemplar's patches, the ones nearest to its middle stay
/// and the others are marked.
/// @param counted  [lattice] 1: the patch holds a surface; others belong to no run
/// @par Cost    O(patches * log(patches))   @par Repeats same bits for any number of threads (uses one)
std::vector<std::uint8_t> patchesTooMany(const PatchLevel& level, const PatchMap& map,
                                         const std::vector<std::uint8_t>& counted, double share);

}  // namespace vdbsynth
