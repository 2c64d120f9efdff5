#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Decides for cells of 2^3 voxels which one of the patches over them is copied there, so that what is copied
/// side by side fits: minimum-error cuts [kwatra2003] by alpha expansion [boykov2001]. A vote of patches that
/// do not agree is a surface that no exemplar has; a cut leaves each side as it is and runs where both look
/// alike.
///
/// A cell c of 2^3 voxels takes a shift s_c: it copies E_s(x + s), E_s being the shift's exemplar. All values
/// are clamped to +-1.5 voxels, so that a wall that one side has and the other has not costs the same
/// wherever a seam crosses it, and counted in 64ths of a voxel. What the shifts are to make small:
///
///     sum_c D(c, s_c) + sum_(c,d) V(c, d, s_c, s_d),  (c, d) all pairs of cells that share a face
///     D(c, s)       = sum over x in c of |E_s(x + s) - F(x)|
///     V(c, d, a, b) = w sum over x in c and d of |E_a(x + a) - E_b(x + b)|,  0 where a = b
///
/// w is 1, and 16 (kAbove) for pairs along an axis that does not grow, along which everything keeps its
/// place. Of a cell that lies beyond an exemplar's end V counts the most that there can be, 2 * 1.5 voxels a
/// voxel.
///
/// Each shift in turn takes those of the cells inside its patches that lower the sum, by a minimum cut;
/// shifts whose cells do not touch do so at once. This is one round of expansions, not the minimum. The
/// options' `longestRun` limits how many of its exemplar's cells with a surface a shift takes, those nearest
/// to its middle first; of a shift that has more from the beginning, each cell too many costs 1500 / 64
/// voxels (kTooLong) more until another shift takes it.
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
