#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Decides for cells of 2^3 voxels which one of the patches over them is copied there, so that what is copied
/// side by side fits: minimum-error cuts [kwatra2003] by alpha expansion [boykov2001]. A vote of patches that
/// do not agree is a surface that no exemplar has; a cut leaves each side as it is and runs where both look
/// alike.
///
/// Costs, with distances clamped to 1.5 voxels, so that a wall that one has and the other has not counts
/// alike wherever the cut crosses it: between neighbouring cells p and q that copy by shifts a and b, the sum
/// over the voxels of both of |E(x + a) - E(x + b)|; and at each cell a fifth of the sum of |E(x + a) -
/// F(x)|, which holds on to what the patches were matched to. Each shift in turn takes what cells it wants of
/// those that its patches cover, by a minimum cut; shifts that cannot meet do so at once. A shift takes no
/// more cells once it has the options' `longestRun` of its exemplar's cells with a surface.
///
/// @param map    of the last pass, of a target that neither tiles nor is known in part
/// @param field  F, what the map's patches were matched to
/// @return the map of the cells: blocks of the cell and a margin of up to two voxels that overlap and vote,
/// so
///         that a seam is a blend over that margin. Sources are places of `map`'s patches or lie inside them
/// @throw Error Cancelled
/// @par Cost    O(cells * shifts that cover one); memory 4 bytes a voxel of target and a byte of exemplar
/// @par Repeats same bits for any number of threads
PatchMap cutSeams(const PatchLevel& level, const PatchMap& map, const BrickField& field,
                  const RunContext& ctx = {});

}  // namespace vdbsynth
