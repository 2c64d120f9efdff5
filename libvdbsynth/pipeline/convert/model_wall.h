#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/measure/minimal_wall.h"
#include "libvdbsynth/vdb/level_set.h"

#include <optional>

namespace vdbsynth {

/// The minimal wall of a model (measure/minimal_wall.h has the definition), with thickness and place in world
/// units. Caps that close a texture at its domain's faces are walls too, as a print has them.
/// @return none as minimalWall, and, with a note, if the solid's box has over 2^34 voxels
/// @throw Error as requireModel (vdb/level_set.h) and minimalWall; EmptyInput (no inside)
/// @par Repeats same bits for any number of threads
std::optional<MinimalWall> modelWall(const LevelSet& model, const MinimalWallOptions& options = {},
                                     const RunContext& ctx = {});

}  // namespace vdbsynth
