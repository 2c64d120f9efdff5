#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

/// 1 where a grid of any type is active, else 0, over `box`, in a field whose box starts at 0.
/// @throw Error BadData (a kind of grid without values, such as points)
/// @param like  the model that the mask is for
/// @throw Error ShapeMismatch unless both have the same transform
BrickField gatherMask(const openvdb::GridBase& grid, const IndexBox& box, const openvdb::FloatGrid& like,
                      const RunContext& ctx = {});

/// @throw Error ShapeMismatch unless the mask has the transform of its model
void requireMaskFor(const openvdb::GridBase& mask, const openvdb::FloatGrid& like);

/// Box of a grid's active voxels. @throw Error EmptyInput (none)
IndexBox activeBox(const openvdb::GridBase& grid);

// Masks: bool grids named "mask", active where true.

/// Every voxel of `box`.
GridPtr boxMask(const IndexBox& box, double voxelSize);
/// Voxels whose centre is within `radius` of `centre`. [world] @throw Error InvalidOption (`radius`)
GridPtr ballMask(const Vec3d& centre, double radius, double voxelSize);
/// Voxels inside a solid.
GridPtr insideMask(const openvdb::FloatGrid& levelSet);
/// Active voxels of a float grid with minimum <= value <= maximum.
GridPtr rangeMask(const openvdb::FloatGrid& grid, double minimum, double maximum);

}  // namespace vdbsynth
