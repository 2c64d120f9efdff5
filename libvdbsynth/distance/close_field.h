#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <array>

namespace vdbsynth {

/// Which faces of a domain cut through the solid: low and high face of x, y, z.
using CutFaces = std::array<bool, 6>;

inline constexpr CutFaces kAllCut{true, true, true, true, true, true};

/// A field [voxels] closed by caps half a voxel outside the cut faces of `domain`, over the domain grown by
/// the band. Beyond the field's own box its nearest samples continue.
/// @param limit  [voxels] largest absolute value of the result
/// @param unit   what a voxel counts in the result
/// @par Repeats same bits for any number of threads
BrickField closeField(const BrickField& field, const IndexBox& domain, const CutFaces& cut, float limit,
                      const RunContext& ctx = {}, float unit = 1);

}  // namespace vdbsynth
