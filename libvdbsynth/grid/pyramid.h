#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// Mean over the cube [p, p + cell)^3 at every voxel p, the levels of all block pyramids at once
/// [lagae2004, section 4.1: nodes refer into a globally averaged pyramid]. Near the box's far faces
/// the cube reads the nearest voxel inside. Sums are double, in a fixed order.
/// An even cell's mean is that of eight cells of half its side, rounded to float each time.
/// @param cell  side of the cube [voxels], at least 1
/// @par Cost    O(bricks that are not constant near them * (log(cell) + (8 + odd)^3)), odd being the cell's
///              largest odd factor
/// @par Repeats same bits for any number of threads
BrickField slidingMean(const BrickField& field, int cell, const RunContext& ctx = {});

/// The sliding mean of a cell of twice the side from that of a cell, if both are needed.
/// @param mean  the slidingMean for `cell`
BrickField twiceSlidingMean(const BrickField& mean, int cell, const RunContext& ctx = {});

/// The field at half the resolution: the mean of each 2x2x2 cube [lagae2004, section 5.2]. The
/// result's box starts at 0 and has ceil(n/2) voxels a side; the half-filled last layer of an odd side
/// averages the existing samples.
/// @param field  box starting at 0
BrickField halved(const BrickField& field, const RunContext& ctx = {});

/// A mask of 0 and 1 at half the resolution: 1 only where all of a cube's samples are.
/// @param mask  box starting at 0
BrickField halvedMask(const BrickField& mask, const RunContext& ctx = {});

/// True if a cube of `block` voxels lies where a mask of 0 and 1 is 1 throughout.
/// @par Cost    as slidingMean
bool blockFitsInside(const BrickField& mask, int block, const RunContext& ctx = {});

/// The field at twice the resolution, box [0, size), by trilinear interpolation between the centres
/// of the coarse voxels (the inverse placement of `halved`).
BrickField doubled(const BrickField& field, const Index3& size, const RunContext& ctx = {});

}  // namespace vdbsynth
