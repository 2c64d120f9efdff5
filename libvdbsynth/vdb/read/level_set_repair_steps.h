#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>

namespace vdbsynth {

/// What closedCuts did.
struct ClosedCuts {
    std::string names;  ///< "low x, high z": the sides of the solid that were open; empty where none was
    CutFaces planes{};  ///< sides where most of what was open lies in one plane, beyond which no solid is
};

/// Closes a solid where its inside ends in a step, at the plane between the voxels of the step; only the sign
/// of its values is right there afterwards.
/// @param unit  what a voxel is in the grid's values
ClosedCuts closedCuts(openvdb::FloatGrid& grid, double unit, const RunContext& ctx);

}  // namespace vdbsynth
