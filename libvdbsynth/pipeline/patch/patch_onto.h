#pragma once
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/patch/onto/onto_synthesis.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/patch/patch_source.h"
#include "libvdbsynth/vdb/level_set.h"

#include <optional>
#include <string>

namespace vdbsynth {

struct PatchOntoOptions {
    OntoOptions onto;
    std::optional<DirectionSource> direction;  ///< of the exemplar's first axis over the model; none: the
                                               ///< smoothest field
};

/// @throw Error InvalidOption (a field out of its range, a direction without its grid or strokes)
void validate(const PatchOntoOptions& options);

/// A model to lay an exemplar over, as a level set of voxels half a field step wide; of a level set that is
/// finer than four to a step or no coarser than that, its own.
/// @param source  the exemplar   @throw Error as loadModel
/// @par Repeats same bits for any number of threads
LevelSet loadOntoModel(const std::string& path, const PatchSource& source, const PatchOntoOptions& options,
                       const RunContext& ctx = {});

/// An exemplar's geometry over a model. The model itself is no part of it.
struct PatchedModel {
    PatchExemplar exemplar;  ///< scaled
    OntoResult result;
    OntoSurface surface;  ///< that it lies on
    Vec3d origin;         ///< [world] that the result's places are relative to
};

/// Lays an exemplar over the zero level of a model (patch/onto/onto_synthesis.h): sites evenly spread on it,
/// a smooth direction field, patches by the exponential map. Faces of a recorded domain that the model
/// touches are cuts and carry nothing. Where the exemplar's height times the model's curvature is over one
/// it would fold: a note says on what share of the surface, and the scale that holds.
/// @throw Error as validate and synthesizeOnto; Unusable (directions along normals only), EmptyInput (no
/// surface)
/// @par Repeats same bits for any number of threads
PatchedModel patchOnto(const PatchSource& source, const LevelSet& model, const PatchOntoOptions& options,
                       const RunContext& ctx = {});

/// The points in the world: normals, what the exemplar carries, and `patch` and `source`, as sheetCloud.
PointCloud ontoCloud(const PatchSource& source, const PatchedModel& patched);

/// The solid that the points bound: distances by projection on them within two voxels, signs by their
/// normals; what is farther from all points is inside only if it is shut in and most of what is known around
/// it is inside.
/// @param withModel  null, or a model that is united with it
/// @throw Error EmptyInput (no surface), Memory, Cancelled
/// @par Cost    some microseconds for each voxel near a point
/// @par Repeats same bits for any number of threads
LevelSet ontoLevelSet(const PatchedModel& patched, double voxelSize, double halfWidth,
                      const LevelSet* withModel = nullptr, const RunContext& ctx = {});

}  // namespace vdbsynth
