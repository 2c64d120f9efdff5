#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/synth/guidance.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// What all rounds of one pass of a texture optimization read.
struct PatchLevel {
    const SynthesisPass* pass = nullptr;
    const BlockSynthesisOptions* options = nullptr;
    std::vector<DenseField> exemplars;  ///< those of the pass
    /// [exemplar] mean of the mask over each patch; constant 1 without a mask.
    std::vector<BrickField> maskMeans;
    std::vector<std::vector<Index3>> fallbacks;  ///< [exemplar] places inside the mask, spread over it
    /// [exemplar] eligible places, a stride apart, whose patches hold a surface
    std::vector<double> surfacePlaces;
    std::vector<std::int32_t> only;  ///< [lattice] the exemplar that sources are in; empty: any
    Guidance guidance;
    std::vector<std::uint8_t> fixed;   ///< [lattice] 1: the patch has nothing open; empty: none is
    std::vector<std::size_t> repeats;  ///< [lattice] the patch that each is the same as; empty: each itself

    bool eligible(std::size_t exemplar, const Index3& place) const {
        return maskMeans[exemplar].inside(place) == 1.f;
    }
    /// True if patch i may have its source in an exemplar.
    bool allows(std::size_t i, std::int32_t exemplar) const {
        return only.empty() || only[i] < 0 || only[i] == exemplar;
    }
    /// True if patch i does not look for a source itself.
    bool keeps(std::size_t i) const {
        return (!fixed.empty() && fixed[i]) || (!repeats.empty() && repeats[i] != i);
    }
};

/// @param masks  for each exemplar, null or missing: none
/// @param open   at the pass's scale; null: none
PatchLevel patchLevel(const SynthesisPass& pass, const BlockSynthesisOptions& options, const PatchMap& map,
                      const std::vector<const BrickField*>& masks, const BrickField* open,
                      const RunContext& ctx);

/// Where the source of the patch at an origin may begin, in exemplar number e.
IndexBox sourcesFor(const PatchLevel& level, const PatchMap& map, std::size_t e, const Index3& origin);

/// Gives every patch of a map an eligible source: of 64 drawn by the context's seed the one that the guidance
/// likes best, without guidance the first.
void drawSources(const PatchLevel& level, PatchMap& map, const RunContext& ctx);

/// Gives every patch of a map on a lattice of its own the source that another map has where the patch's
/// middle is, `factor` times the scale apart, or the nearest that it may have.
void liftSources(const PatchLevel& level, const PatchMap& coarse, int factor, PatchMap& map,
                 const RunContext& ctx);

/// Gives every patch that repeats another its source and weight.
void copyRepeats(const PatchLevel& level, PatchMap& map);

}  // namespace vdbsynth
