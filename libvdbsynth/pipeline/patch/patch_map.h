#pragma once
#include "libvdbsynth/pipeline/patch/patch_outputs.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The source map of a sheet: which patch every node of it is copied from, and all that makes its points of
/// an exemplar again.
struct PatchMapFile {
    PatchArrangement arrangement;
    PatchOptions options;  ///< of the run; size, border, tile, warp, blend and overlap count
    PatchBox box;          ///< of the exemplar, axes as in the file
    PatchPlane plane = PatchPlane::XY;
};

/// As a grid `patch_label` of whole numbers on the nodes of the sheet, in its axes, with the patches as
/// metadata.
/// @throw Error Unusable (a sheet of the paper's method, which has no map)
GridPtr patchMapGrid(const PatchSource& source, const PatchSheet& sheet, const PatchOptions& options);

/// The map among the grids of a file; none if there is no `patch_label`.
/// @throw Error BadData (an inconsistent one) @param path  begins the message
std::optional<PatchMapFile> patchMapFrom(const std::string& path, const std::vector<GridPtr>& grids);

/// A sheet of the map's arrangement from an exemplar of the same box: the run's own gives the same points bit
/// for bit, another one, finer or with other attributes, the same arrangement of it.
/// @param source  loaded with the map's box and plane (PatchSourceOptions::box)
/// @throw Error ShapeMismatch (patches beyond the exemplar), Memory, Cancelled
PatchSheet repeatPatchSheet(const PatchSource& source, const PatchMapFile& map, const RunContext& ctx = {});

}  // namespace vdbsynth
