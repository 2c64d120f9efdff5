#pragma once
#include "libvdbsynth/synth/block_synthesis.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// One pass of a block synthesis, in its own averaged-down voxels.
struct SynthesisPass {
    std::vector<std::shared_ptr<const BrickField>> exemplars;
    Index3 target;
    int block = 0;
    int scale = 1;  // voxels of the last pass per voxel of this one
};

/// Positions at which the source of a block or patch with a given origin may begin: anywhere inside the
/// exemplar along a growing axis (at object borders by the contract), within the drift of its own position
/// along the others.
/// @param side  of the block [the pass's voxels]   @return may be empty
IndexBox sourceBox(const BlockSynthesisOptions& options, const SynthesisPass& pass, const Index3& exemplar,
                   int side, const Index3& origin);

/// The exemplar that a block takes its source from, by the voxel of the pass's target at its middle; -1: any.
int exemplarAt(const BlockSynthesisOptions& options, const SynthesisPass& pass, const Index3& middle);

/// The masks of all exemplars at the scale of one pass; null: none.
struct PassMasks {
    std::vector<std::shared_ptr<const BrickField>> held;
    std::vector<const BrickField*> each;
};

/// For each pass, finest first. Empty entries where there are no masks.
std::vector<PassMasks> masksOf(const BlockSynthesisOptions& options, std::size_t passes,
                               const RunContext& ctx);

/// The passes, finest first, at most `levels`. Coarser ones end where a block would have fewer than four
/// samples or the period of a target that tiles is odd; a note reports this if the options ask for more.
std::vector<SynthesisPass> planPasses(const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                      const BlockSynthesisOptions& options, int block, int levels,
                                      const RunContext& ctx);

}  // namespace vdbsynth
