#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/synth/synthesis_passes.h"

namespace vdbsynth {

/// Fills the open samples of a pass's field with the best match for the known ones [lagae2004, section 6,
/// left open]: of all blocks with open samples, the one with the most known samples comes next; its exact
/// best match under the mask of known samples fills the rest, until nothing is open.
/// @param field  [the pass's target] known samples are compared, open ones are replaced
/// @param open   1 where a sample is open, else 0; the same box
/// @param masks  for each exemplar, null or missing: none
/// @return the lattice of blocks, half a block apart, with the source of every matched block; blocks without
/// open samples have the source of the first matched block
/// @throw Error Unusable (no block of any exemplar is eligible), Memory, Cancelled
/// @par Cost    O(open blocks * one search), for the coarsest pass   @par Repeats same bits for any threads
PatchMap fillOpen(const SynthesisPass& pass, const std::vector<const BrickField*>& masks,
                  const BrickField& open, BrickField& field, const RunContext& ctx = {});

}  // namespace vdbsynth
