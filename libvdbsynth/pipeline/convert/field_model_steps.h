#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

/// A level set over `domain`, closed by caps half a voxel outside it, from a field that
/// extends some voxels beyond.
/// @param field   negative inside; box in the index space of the result
/// @param limit   largest absolute value of the field, at least kHalfWidth
/// @param exact   its values are distances [voxels]; false: its zero level is used, and
/// @param band    [voxels] its values up to there, where they are good distances; 0: none
/// @param what, hint  begin and end of the message if the domain is empty
/// @throw Error EmptyInput, Cancelled
/// @par Repeats same bits for any number of threads
LevelSet modelFromField(const BrickField& field, float limit, bool exact, float band, const IndexBox& domain,
                        double voxelSize, const std::string& what, const std::string& hint,
                        const RunContext& ctx = {});

}  // namespace vdbsynth
