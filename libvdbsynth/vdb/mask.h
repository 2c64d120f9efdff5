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

/// The solid that a mask is, as a level set: a level set, or distances of no class. Null: it holds numbers or
/// truths. @param what  the option, for messages   @throw Error as modelFromGrids (vdb_file.h)
FloatGridConstPtr solidOfMask(const openvdb::GridBase& mask, const std::string& what,
                              const RunContext& ctx = {});

/// A mask as a grid that is active where it holds, in its model's voxels: a solid is active where the centre
/// of a voxel lies inside it, whatever its own voxels and band; any other grid where its voxel nearest to the
/// centre is active; of the mask only what lies in the model's active box or recorded domain. The same grid
/// if it has these voxels and is no solid.
/// @throw Error as solidOfMask; BadData (a kind of grid that cannot be a mask), EmptyInput (it holds
/// nowhere, or lies beside the model), Memory   @par Cost O(voxels that mask and model share)   @par Repeats
/// same bits for any number of threads
GridConstPtr maskOn(const GridConstPtr& mask, const openvdb::FloatGrid& like, const std::string& what,
                    const RunContext& ctx = {});

/// Box of a grid's active voxels. @throw Error EmptyInput (none)
IndexBox activeBox(const openvdb::GridBase& grid);

// Masks: bool grids named "mask", active where true.

/// Every voxel of `box`.
GridPtr boxMask(const IndexBox& box, double voxelSize);
/// Voxels whose centre is within `radius` of `centre`. [world]
/// @throw Error InvalidOption (`radius`), Cancelled
GridPtr ballMask(const Vec3d& centre, double radius, double voxelSize, const RunContext& ctx = {});
/// Voxels inside a solid. @throw Error Cancelled
GridPtr insideMask(const openvdb::FloatGrid& levelSet, const RunContext& ctx = {});
/// Active voxels of a float grid with minimum <= value <= maximum. @throw Error InvalidOption (`minimum`),
/// Cancelled
GridPtr rangeMask(const openvdb::FloatGrid& grid, double minimum, double maximum, const RunContext& ctx = {});

}  // namespace vdbsynth
