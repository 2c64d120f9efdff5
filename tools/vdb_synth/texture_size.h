#pragma once
#include "libvdbsynth/vdb/level_set.h"
#include "tools/vdb_synth/option_set.h"

#include <string>

namespace vdbsynth::cli {

/// [voxels] of a model's domain.
double longestSide(const LevelSet& model);

/// The --scale that lays a sample of `side` voxels over --texture-size on a target. Features keep their size
/// in world units whatever the target's voxels are.
/// @param finer  the option that makes the sample finer or coarser, for the message
/// @throw Error InvalidOption (with --scale as well; a scale that the command does not allow)
double scaleOfSize(const Arguments& arguments, double side, double voxelSize, const std::string& finer);

}  // namespace vdbsynth::cli
