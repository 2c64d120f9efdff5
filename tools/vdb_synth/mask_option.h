#pragma once
#include "tools/vdb_synth/command.h"

#include <string>

namespace vdbsynth::cli {

/// @throw Error InvalidOption (--NAME is a picture)
void refusePicture(const Arguments& arguments, const std::string& name);

/// The value of --NAME, a Kind::ModelOrGrid: a grid of a .vdb as it is, or another model as a level set with
/// voxels of `voxelSize` (world) and a band of `halfWidth` voxels.
/// @throw Error as Run::loadGrid and loadModel
GridConstPtr maskOf(Run& run, const std::string& name, double voxelSize, double halfWidth = 3);

}  // namespace vdbsynth::cli
