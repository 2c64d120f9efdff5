#pragma once
#include "libvdbsynth/synth/patch_level.h"

namespace vdbsynth {

/// Chooses for cells of 2^3 voxels which of the patches over them is copied there, so that adjacent copies
/// fit: minimum-error cuts [kwatra2003] by alpha expansion [boykov2001]. A vote of patches that disagree is a
/// surface that no exemplar has; a cut leaves each side unchanged and runs where both sides are similar.
///
/// A cell c of 2^3 voxels takes a shift s_c: it copies E_s(x + s), where E_s is the shift's exemplar. All
/// values are clamped to +-1.5 voxels, so that a wall that only one side has costs the same wherever a seam
/// crosses it, and are counted in 64ths of a voxel. The shifts minimise:
///
///     sum_c D(c, s_c) + sum_(c,d) V(c, d, s_c, s_d),  (c, d) all pairs of cells that share a face
///     D(c, s)       = sum over x in c of |E_s(x + s) - F(x)|
///     V(c, d, a, b) = w sum over x in c and d of |E_a(x + a) - E_b(x + b)|,  0 where a = b
///
/// w is 1, and 16 (kAbove) for pairs along an axis that does not grow, along which everything keeps its
/// position. For a cell beyond an exemplar's end V has its maximum, 2 * 1.5 voxels per voxel.
///
/// Each shift in order takes the cells inside its patches that lower the sum, by a minimum cut; shifts whose
/// cells do not touch are processed in parallel. This is one round of expansions, not the minimum. The
/// options' `longestRun` limits how many of its exemplar's cells with a surface a shift takes, those nearest
/// to its middle first. If a shift has more from the beginning, each excess cell costs 1500 / 64 voxels
/// (kTooLong) more until another shift takes it.
///
/// @param map    of the last pass, for a target that does not tile and is not partly known
/// @param field  F, the field that the map's patches were matched to
/// @return the map of the cells: blocks of a cell and a margin of up to two voxels that overlap and vote, so
/// that a seam is a blend over that margin. Sources are positions of `map`'s patches or lie inside them
/// @throw Error Cancelled
/// @par Cost    O(cells * shifts that cover one); memory 4 bytes per voxel of the target
/// and 1 per voxel of exemplar
/// @par Repeats same bits for any number of threads
PatchMap cutSeams(const PatchLevel& level, const PatchMap& map, const BrickField& field,
                  const RunContext& ctx = {});

}  // namespace vdbsynth
