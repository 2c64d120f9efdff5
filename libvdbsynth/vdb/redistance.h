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

/// A field's zero level on the lattice of another grid, with a band of `halfWidth` voxels: cavities stay
/// (distance/rebuild_band.h, resampleBand). In a level set distances that are good ones stay too.
/// @param field    negative inside; a level set's values are distances in world units
/// @param lattice  its transform, linear with cubic voxels, becomes that of the result; its values are not
/// read
/// @throw Error EmptyInput "WHAT has no surface ...", Memory, Cancelled
/// @par Repeats same bits for any number of threads
FloatGridPtr resampleLevelSet(const openvdb::FloatGrid& field, const openvdb::FloatGrid& lattice,
                              float halfWidth, const std::string& what, const RunContext& ctx = {});

}  // namespace vdbsynth
