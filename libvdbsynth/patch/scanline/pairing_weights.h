#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_exemplar.h"
#include "libvdbsynth/patch/patch_field.h"
#include "libvdbsynth/patch/scanline/point_pairing.h"

namespace vdbsynth {

/// Weights of pairing that nobody has to set: every term counts in units of what it costs between places of
/// the exemplar that match well. At `probes` places, drawn by the seed, the best other place is looked up
/// (nearMatchLevel), points of both overlaps that are each other's nearest and whose normals are within 60
/// degrees are taken for true pairs, and w_x = mean position term / mean of the term x, w_p = 1. A term that
/// is 0 everywhere gets the weight 1.
/// @param variation  [points] of the exemplar
/// @param patch, overlap  [columns]
/// @return the defaults of PairingWeights if there is no pair
/// @par Cost    as `probes` searches   @par Repeats same bits for any number of threads
PairingWeights nearMatchWeights(const PatchExemplar& exemplar, const std::vector<float>& variation,
                                const PatchField& field, int patch, int overlap, int probes,
                                const RunContext& ctx = {});

}  // namespace vdbsynth
