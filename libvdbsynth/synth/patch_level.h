#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/synth/guidance.h"
#include "libvdbsynth/synth/synthesis_passes.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// Input shared by all rounds of one pass of a texture optimization.
struct PatchLevel {
    const SynthesisPass* pass = nullptr;
    const BlockSynthesisOptions* options = nullptr;
    std::vector<DenseField> exemplars;  ///< those of the pass
    /// [exemplar] mean of the mask over each patch; constant 1 without a mask.
    std::vector<BrickField> maskMeans;
    std::vector<std::vector<Index3>> fallbacks;  ///< [exemplar] positions inside the mask, spread over it
    /// [exemplar] eligible positions, a stride apart, whose patches hold a surface
    std::vector<double> surfacePlaces;
    std::vector<std::int32_t> only;  ///< [lattice] the exemplar that sources must be in; empty: any
    Guidance guidance;
    std::vector<std::uint8_t> fixed;  ///< [lattice] 1: no sample is open; empty: every patch has open samples
    std::vector<std::size_t> repeats;  ///< [lattice] the patch that each repeats; empty: each is its own

    bool eligible(std::size_t exemplar, const Index3& place) const {
        return maskMeans[exemplar].inside(place) == 1.f;
    }
    /// True if patch i may have its source in an exemplar.
    bool allows(std::size_t i, std::int32_t exemplar) const {
        return only.empty() || only[i] < 0 || only[i] == exemplar;
    }
    /// True if patch i does not search for a source itself.
    bool keeps(std::size_t i) const {
        return (!fixed.empty() && fixed[i]) || (!repeats.empty() && repeats[i] != i);
    }
};

/// @param masks  for each exemplar, null or missing: none
/// @param open   at the pass's scale; null: none
PatchLevel patchLevel(const SynthesisPass& pass, const BlockSynthesisOptions& options, const PatchMap& map,
                      const std::vector<const BrickField*>& masks, const BrickField* open,
                      const RunContext& ctx);

/// Box of the source positions for the patch at an origin, in exemplar number e.
IndexBox sourcesFor(const PatchLevel& level, const PatchMap& map, std::size_t e, const Index3& origin);

/// Gives every patch of a map an eligible source: of 64 drawn by the context's seed the one with the least
/// guidance cost, without guidance the first.
void drawSources(const PatchLevel& level, PatchMap& map, const RunContext& ctx);

/// Gives every patch of a map on another lattice the source of another map at the patch's middle, at `factor`
/// times the scale, or the nearest eligible source.
void liftSources(const PatchLevel& level, const PatchMap& coarse, int factor, PatchMap& map,
                 const RunContext& ctx);

/// Gives every patch that repeats another that patch's source and weight.
void copyRepeats(const PatchLevel& level, PatchMap& map);

}  // namespace vdbsynth
