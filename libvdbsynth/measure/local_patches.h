#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/measure/functionals.h"
#include "libvdbsynth/measure/measures.h"

namespace vdbsynth {

/// A solid prepared for comparing local patches.
struct PatchBits {
    Occupancy solid;
    Beyond beyond = Beyond::Void;
};

/// Local-patch similarity of `other` to `reference`; see LocalPatches (measures.h) for the definition.
/// @par Cost    1000 patches of `other` times the patches of `reference`
/// @par Repeats same bits for ctx.seed, any number of threads
LocalPatches localPatchSimilarity(const PatchBits& reference, const PatchBits& other,
                                  const RunContext& ctx = {});

}  // namespace vdbsynth
