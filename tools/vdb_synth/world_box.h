#pragma once
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/math/index_box.h"
#include "tools/vdb_synth/option_value.h"

#include <string>

namespace vdbsynth::cli {

/// The voxels that a box of the command line holds: its whole numbers, and of its lengths the voxels whose
/// centres lie from the lower one up to, but not on, the upper one. Boxes that touch share no voxel and miss
/// none.
/// @param transform  from voxels to the world   @param given  the option and its value, for messages
/// @throw Error InvalidOption (no voxel, too far away; lengths where the voxels are rotated in the world)
IndexBox voxelsOf(const BoxValue& box, const Affine& transform, const std::string& given);

}  // namespace vdbsynth::cli
