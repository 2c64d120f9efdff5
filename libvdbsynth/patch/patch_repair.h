#pragma once
#include "libvdbsynth/patch/patch_synthesis.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// [world] The step of the field that a sheet is repaired by: as `step` says, else 2 spacings, or more where
/// its box has over 288 of these along its longer side.
double repairStep(const PatchExemplar& sheet, const PatchOptions& options);

struct RepairResult {
    std::vector<std::uint32_t> kept;  ///< numbers of the sheet's points that are not touched, ascending
    /// All others, plane space of the sheet: those of what stays that were moved at the hole's border, patch
    /// 0, and those of the patches. `source` is a number of the sheet's points, or, from `first` on, that
    /// plus one of the exemplar's.
    SheetPoints made;
    std::uint32_t first = 0;
    std::size_t removed = 0;                  ///< points of the sheet that lay in the hole
    double patch = 0, overlap = 0, step = 0;  ///< [world] as used
    std::size_t patches = 0;                  ///< laid into the hole
    BorderStats borders;
    double search = 0, warp = 0, other = 0;  ///< [seconds]
};

/// Fills a hole of a sheet with patches of the rest of it, or of an exemplar. What stays is one patch that
/// is never moved (layout/patch_hole_layout.h); it is placed against, cut, warped at its border and blended
/// like any other. Points farther than twice the overlap and the blending's two steps from the hole are not
/// touched. Points in the hole's columns are dropped before anything is measured; at one column around it
/// distances refer to what is gone, so that this too is filled, and it is nowhere copied from.
///
/// Where no patch is asked for, it is that of the texture (patch_size.h), or smaller until it fits at 64
/// places beside the hole, with a note.
/// @param sheet     its box holds all its points
/// @param hole      [columns of latticeOf(sheet.size, repairStep)] other than 0: in the hole
/// @param exemplar  of the same plane, or null: the sheet itself. Its heights count from the sheet's own
/// where medians agree within a step, else its median is put at the sheet's, with a note
/// @param options   patch, overlap, tolerance, step, repairs, warp and blend are read
/// @throw Error InvalidOption, ShapeMismatch (another number of columns), Unusable (a hole that is nothing or
/// everything, no place for a patch), Memory, Cancelled
/// @par Cost    as synthesizePatches of the hole, and the sheet's field
/// @par Repeats same bits for any number of threads
RepairResult repairPatches(const PatchExemplar& sheet, const std::vector<std::uint8_t>& hole,
                           const PatchExemplar* exemplar, const PatchOptions& options,
                           const RunContext& ctx = {});

}  // namespace vdbsynth
