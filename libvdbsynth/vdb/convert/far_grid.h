#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>

namespace vdbsynth {

/// Index coordinates below this are exact in floats to a sixteenth of a voxel; a grid farther out keeps an
/// offset in its transform.
inline constexpr int kFarVoxels = 1 << 20;

/// An origin as whole voxels and the rest.
struct WholeVoxels {
    Vec3d voxels;  ///< whole multiples of 8: a grid moves by them without a change to its leaves
    Vec3d rest;    ///< [world] up to four voxels
    bool none() const { return voxels.x == 0 && voxels.y == 0 && voxels.z == 0 && length(rest) == 0; }
};

/// @param origin     [world]
/// @param voxelSize  [world]
WholeVoxels wholeVoxels(const Vec3d& origin, double voxelSize);

/// A grid with a pure scale, moved to its place: its voxels move, or beyond kFarVoxels its transform does,
/// with a note. The rest is not applied.
/// @param grid  taken over
FloatGridPtr movedBy(const FloatGridPtr& grid, const WholeVoxels& place, const std::string& name,
                     const RunContext& ctx = {});

/// The grid with its voxels near zero and their offset in the transform, if its active ones lie beyond
/// kFarVoxels; else the grid. No voxel's place in the world changes.
/// @par Cost    O(leaves)
FloatGridPtr nearZero(const FloatGridPtr& grid);

/// @throw Error Unusable "NAME: ..." if voxels of this size cannot be: OpenVDB's transforms end at 1.45e-5
void requireVoxelSize(double voxelSize, const std::string& name);

}  // namespace vdbsynth
