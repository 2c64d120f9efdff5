#pragma once
#include "libvdbsynth/synth/block_synthesis.h"

#include <memory>
#include <vector>

namespace vdbsynth {

/// One pass of a block synthesis: everything in its own, averaged-down voxels.
struct SynthesisPass {
    std::vector<std::shared_ptr<const BrickField>> exemplars;
    Index3 target;
    int block = 0;
    int scale = 1;  // voxels of the last pass in one of this
};

/// The passes, finest first; coarser ones end where a block would fall under four samples.
std::vector<SynthesisPass> planPasses(const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                      const BlockSynthesisOptions& options, int block, const RunContext& ctx);

}  // namespace vdbsynth
