#pragma once
#include "tools/vdb_synth/command.h"

namespace vdbsynth::cli {

/// The minimal wall of a result (pipeline/convert/model_wall.h), where it is asked for: with --report as
/// "minimal_wall" [world, null: not found] and "minimal_wall_at" in "counts", with -v of outputs for printing
/// (.stl, .3mf) as a line.
void reportWall(Run& run, const LevelSet& result);

}  // namespace vdbsynth::cli
