#pragma once
#include "libvdbsynth/vdb/level_set.h"
#include "tools/vdb_synth/option_set.h"

#include <string>

namespace vdbsynth::cli {

/// [voxels] of a model's domain.
double longestSide(const LevelSet& model);

/// The --scale that lays a sample of `side` voxels over --texture-size on a target. Features keep their size
/// in world units whatever the target's voxels are.
/// @param sample  its file, for what the message advises
/// @throw Error InvalidOption (with --scale as well; a scale that the command does not allow)
double scaleOfSize(const Arguments& arguments, double side, double voxelSize, const std::string& sample);

/// The same of `texture`: the scale that lays the longest side of an image, in pixels, over --texture-size.
/// @param spacing  siteSpacing of the target [world]
/// @throw Error InvalidOption (as above), Unusable (no two points)
double scaleOfImage(const Arguments& arguments, double pixels, double spacing);

}  // namespace vdbsynth::cli
