#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

/// The part of a model inside an index box, capped half a voxel outside it; the box is its recorded domain.
/// @throw Error InvalidOption (an empty box) and what requireModel (vdb/level_set.h) throws; EmptyInput
/// (nothing in the box), Memory, Cancelled
/// @par Repeats same bits for any number of threads
LevelSet cropModel(const LevelSet& model, const IndexBox& box, const RunContext& ctx = {});

}  // namespace vdbsynth
