#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>

namespace vdbsynth {

/// Closes a solid where its inside ends in a step, at the plane between the voxels of the step; only the sign
/// of its values is right there afterwards.
/// @param unit  what a voxel is in the grid's values
/// @return "low x, high z": the sides of the solid that were open; empty where none was
std::string closedCuts(openvdb::FloatGrid& grid, double unit, const RunContext& ctx);

}  // namespace vdbsynth
