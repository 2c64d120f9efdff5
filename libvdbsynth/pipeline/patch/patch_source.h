#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/attribute.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/patch/patch_exemplar.h"
#include "libvdbsynth/pipeline/convert/model.h"

#include <optional>
#include <string>

namespace vdbsynth {

struct PatchSourceOptions {
    ModelOptions model;               ///< of exemplars that are meshes, grids or rasters
    std::optional<PatchPlane> plane;  ///< none: the file's own, else across the shortest side
    /// [world] at least 0: how far the points continue beyond the box, where the file does not say the box;
    /// none:
    /// a third of a patch, of level sets what fields read beyond the box, 7 spacings.
    std::optional<double> margin;
    bool whole = false;  ///< the box is that of the points, whatever the file says, and `margin` is not read;
                         ///< PatchSource::cloud is kept
    std::optional<PatchBox> box;  ///< [world] the texture's, height included; the file's is not read then
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PatchSourceOptions& options);

/// A geometry texture and what it carries.
struct PatchSource {
    PatchExemplar exemplar;
    Attributes attributes;  ///< of the file's points, in the order of PatchExemplar::number
    double voxelSize = 1;   ///< [world] of level sets made of it
    bool recorded = false;  ///< the file says its box
    /// Of a whole source the points as they were read, without attributes, in the order of
    /// PatchExemplar::number.
    PointCloud cloud;
    bool isPoints = false;  ///< the file holds points
};

/// Any supported geometry as a texture of oriented points.
/// - Points: as they are. Without normals these are estimated, with a note. The box is that of the file's
///   header (io/texture_box.h), else their bounds less the margin.
/// - Everything else becomes a level set, and that points half a voxel apart. Points on the caps at its
/// domain's
///   sides (the cuts through the texture) are left out; the box is the domain less the margin.
/// What is guessed is a note.
/// @throw Error as loadModel and readPoints; EmptyInput (fewer than 32 points, none in the box), Unusable (a
/// margin that leaves no box)
/// @par Repeats same bits for any number of threads
PatchSource loadPatchSource(const std::string& path, const PatchSourceOptions& options,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
