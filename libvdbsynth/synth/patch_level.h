#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/grid/patch_map.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// What all rounds of one pass of a texture optimization read.
struct PatchLevel {
    const SynthesisPass* pass = nullptr;
    const BlockSynthesisOptions* options = nullptr;
    std::vector<DenseField> exemplars;  ///< those of the pass
    std::vector<BrickField> maskMeans;  ///< mean of the mask over each patch of the first; empty: no mask
    std::vector<Index3> fallbacks;      ///< places inside the mask, spread over it; empty: no mask
    double surfacePlaces = 1;           ///< places, a stride apart, whose patches hold a surface
    std::vector<std::uint8_t> fixed;    ///< [lattice] 1: the patch has nothing open; empty: none is
    std::vector<std::size_t> repeats;   ///< [lattice] the patch that each is the same as; empty: each itself

    /// True if patch i does not look for a source itself.
    bool keeps(std::size_t i) const {
        return (!fixed.empty() && fixed[i]) || (!repeats.empty() && repeats[i] != i);
    }
};

/// @param mask, open  at the pass's scale; null: none
PatchLevel patchLevel(const SynthesisPass& pass, const BlockSynthesisOptions& options, const PatchMap& map,
                      const BrickField* mask, const BrickField* open, const RunContext& ctx);

/// Where the source of the patch at an origin may begin, in exemplar number e.
IndexBox sourcesFor(const PatchLevel& level, const PatchMap& map, std::size_t e, const Index3& origin);

/// Gives every patch of a map on a lattice of its own the source that another map has where the patch's
/// middle is, `factor` times the scale apart, or the nearest that it may have.
void liftSources(const PatchLevel& level, const PatchMap& coarse, int factor, PatchMap& map);

/// Gives every patch that repeats another its source and weight.
void copyRepeats(const PatchLevel& level, PatchMap& map);

}  // namespace vdbsynth
