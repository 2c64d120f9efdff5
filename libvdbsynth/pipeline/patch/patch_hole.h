#pragma once
#include "libvdbsynth/patch/patch_repair.h"
#include "libvdbsynth/pipeline/patch/patch_outputs.h"
#include "libvdbsynth/pipeline/patch/patch_source.h"
#include "libvdbsynth/vdb/level_set.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The columns of a sheet that a box reaches into, through the sheet's whole height; [columns of
/// latticeOf(sheet.size, step)], 1: in the hole. Points of these columns above or below the box are a
/// warning: they are replaced too.
/// @param box   [world] minimum below maximum along every axis
/// @param step  [world] repairStep
/// @throw Error InvalidOption (an empty box), Unusable (a box beside the sheet)
std::vector<std::uint8_t> holeColumns(const PatchSource& sheet, const PatchBox& box, double step,
                                      const RunContext& ctx = {});
/// The same for the inside of a model; a column is in the hole if one of its nodes is.
std::vector<std::uint8_t> holeColumns(const PatchSource& sheet, const LevelSet& hole, double step,
                                      const RunContext& ctx = {});

/// A sheet whose hole was filled.
struct RepairedSheet {
    RepairResult repair;
    PointCloud cloud;  ///< the points that stay, as they were read and in their order, then all others; with
                       ///< the sheet's attributes, `patch` (0: of the sheet) and `source`
    PatchSheet sheet;  ///< all points, for sheetLevelSet
};

/// Fills a hole of a sheet (patch/patch_repair.h). Points that are not touched come out bit for bit.
/// Attributes that an exemplar lacks are 0 on what is copied from it, and those that only it has are left
/// out, both with a warning. `source` counts the sheet's points, then the exemplar's.
/// @param sheet     loaded whole (PatchSourceOptions::whole)
/// @param hole      of holeColumns
/// @param exemplar  or null: the sheet itself
/// @throw Error as repairPatches; ShapeMismatch (a sheet that was not loaded whole)
/// @par Repeats same bits for any number of threads
RepairedSheet repairSheet(const PatchSource& sheet, const std::vector<std::uint8_t>& hole,
                          const PatchSource* exemplar, const PatchOptions& options,
                          const RunContext& ctx = {});

}  // namespace vdbsynth
