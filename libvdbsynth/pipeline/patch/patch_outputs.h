#pragma once
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/patch/patch_synthesis.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/patch/patch_source.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A sheet in the world: the exemplar's corner is the sheet's, axes as in the file.
struct PatchSheet {
    PatchResult result;
    double width = 0, depth = 0;  ///< [world] along the plane's axes
    double border = 0;            ///< [world] how far result's points continue beyond that
};

/// The points of the sheet itself, without its border, in the world: normals, what the exemplar carries, and
/// `patch` and `source`, numbers of the patch that brought each and of the exemplar's point that it copies.
PointCloud sheetCloud(const PatchSource& source, const PatchSheet& sheet);

/// The solid below, or within, the sheet's points: distances by projection on them, signs by their normals,
/// capped at the sheet's sides, its domain recorded.
/// @throw Error EmptyInput, Memory, Cancelled
/// @par Repeats same bits for any number of threads
LevelSet sheetLevelSet(const PatchSource& source, const PatchSheet& sheet, double voxelSize, double halfWidth,
                       const RunContext& ctx = {});

/// Gives a level set of points what they carry, but `patch` and `source`, which are numbers of points: a grid
/// for each attribute over the band, colours as `Cd` (vdb/convert/attribute_grids.h). Meshes of it carry the
/// same at their vertices.
/// @par Repeats same bits for any number of threads
void carryAttributes(const PointCloud& cloud, LevelSet& model, const RunContext& ctx = {});

/// True for a path that takes points: .ply. All others take the level set, or a mesh of it (writeModel).
bool takesPoints(const std::string& path);

}  // namespace vdbsynth
