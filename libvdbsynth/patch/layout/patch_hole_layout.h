#pragma once
#include "libvdbsynth/patch/layout/patch_layout.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Fills a hole of a sheet by patches. Patch 0 is what stays: columns (0, 0) to (nx, ny) of the exemplar in
/// place, never moved. Over every connected part of the hole patches are laid as by layPatches, those that
/// touch most of what stays first, each compared with all that lies under it; one in the middle where that
/// covers the part and the overlap around it. Columns farther than the overlap from the hole are fixed; cuts
/// run nearer to it. Then the worst seams are mended.
/// @param exemplar  begins with the sheet's field; may go on with other texture beyond column nx
/// @param nx, ny    columns of the sheet
/// @param hole      [nx x ny, i first] other than 0: to be filled
/// @param options   `barred` must hold at least the hole; tile must be false
/// @throw Error InvalidOption (a field out of its range), ShapeMismatch (another number of columns), Unusable
/// (a patch larger than the sheet or the exemplar, no place for one, a hole that is nothing or everything),
/// Memory, Cancelled
/// @par Cost    as layPatches   @par Repeats same bits for any number of threads
PatchArrangement layIntoHole(const PatchField& exemplar, int nx, int ny,
                             const std::vector<std::uint8_t>& hole, const LayoutOptions& options,
                             const RunContext& ctx = {});

/// The columns within `reach` of a marked one along any axis or diagonally, of nx x ny, i first.
/// @par Cost    O(columns)   @par Repeats yes
std::vector<std::uint8_t> widenedColumns(const std::vector<std::uint8_t>& columns, int nx, int ny, int reach);

}  // namespace vdbsynth
