#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

/// Distances to the zero level of any field whose sign separates inside and outside, as a valid narrow band
/// (distance/rebuild_band.h); large fields are processed in parts.
/// @param field      negative inside; any transform of uniform voxels, which the result keeps
/// @param halfWidth  [voxels], at least 1.5
/// @param what       begins the message
/// @throw Error EmptyInput "WHAT has no surface ..."
/// @par Repeats same bits for any number of threads
FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx = {});

}  // namespace vdbsynth
