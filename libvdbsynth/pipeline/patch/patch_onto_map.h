#pragma once
#include "libvdbsynth/pipeline/patch/patch_onto.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The source map of an exemplar over a model: the model's sites, which patch every node over them is copied
/// from, and all that makes its points of an exemplar again. The model itself is not needed.
struct PatchOntoMapFile {
    std::vector<Vec3f> points, normals, tangents;  ///< [sites]
    OntoArrangement arrangement;                   ///< its disks have only a centre
    OntoOptions options;                           ///< of the run; scale, warp and blend count
    double zero = 0;                               ///< OntoResult::zero
    Vec3d origin;                                  ///< PatchedModel::origin
    PatchBox box;                                  ///< of the exemplar, axes as in the file
    PatchPlane plane = PatchPlane::XY;
};

/// Two grids: `patch_onto` of whole numbers, of site s and node k at (s / 64, s mod 64, k), with the patches
/// as metadata; and `patch_onto_sites` of vectors: place, normal and tangent of site s at (s / 64, s mod 64,
/// 0 to 2).
std::vector<GridPtr> patchOntoMapGrids(const PatchSource& source, const PatchedModel& patched,
                                       const PatchOntoOptions& options);

/// The map among the grids of a file; none if there is no `patch_onto`.
/// @throw Error BadData (an inconsistent one) @param path  begins the message
std::optional<PatchOntoMapFile> patchOntoMapFrom(const std::string& path, const std::vector<GridPtr>& grids);

/// The map's arrangement of an exemplar with the same box: the run's own gives the same points bit for bit,
/// another one, finer or with other attributes, the same arrangement of it.
/// @param source  loaded with the map's box and plane (PatchSourceOptions::box)
/// @throw Error ShapeMismatch (an exemplar or a map that does not fit), Memory, Cancelled
PatchedModel repeatPatchOnto(const PatchSource& source, const PatchOntoMapFile& map,
                             const RunContext& ctx = {});

}  // namespace vdbsynth
