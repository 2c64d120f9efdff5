#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/convert/volume_output.h"
#include "libvdbsynth/raster/raster_options.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <string>
#include <vector>

namespace vdbsynth {

struct ModelOutputOptions {
    bool points = false;    ///< .ply holds points with normals instead of a mesh
    bool sharp = false;     ///< meshes keep sharp edges and corners, from the model's source if it has one
    double adaptivity = 0;  ///< 0..1, for meshes
    double spacing = 1;     ///< [voxels] between points, 0.25..100
    HeightPlane plane = HeightPlane::XY;  ///< of height images
    double height = 0;                    ///< [world] height of white in a .png; 0: that of the highest point
    std::string unit;  ///< of the world, for a model whose file named none (model_unit.h); empty: unknown
    VolumeValues values = VolumeValues::Inside;  ///< of volumes
    std::vector<GridPtr> extraGrids;             ///< written next to `surface` into .vdb outputs
    std::string name;                            ///< of the level set's grid in .vdb outputs; empty: surface
    bool half = false;     ///< .vdb outputs hold the floats of the level set and of its attributes as halves
    VdbMetadata metadata;  ///< of .vdb outputs
};

/// @throw Error InvalidOption (a field out of its range, both `sharp` and `adaptivity`, null grids)
void validate(const ModelOutputOptions& options);

/// @throw Error InvalidOption if writeModel does not support a path's extension
void requireOutputPaths(const std::vector<std::string>& paths);

/// Writes one model to every path, its kind by extension: .vdb, .obj, .ply, .stl, .off, .glb, .gltf, .3mf;
/// .npy, .tif, .vti, .nii and .nii.gz are volumes (pipeline/convert/volume_output.h);
/// .png (16 bits) and .exr hold the height of the topmost surface over the domain, one pixel per voxel. The
/// mesh is made once; with `adaptivity` slivers are removed from it (geometry/sliver_removal.h), which moves
/// the surface by at most 0.2 voxels and no vertex, and a detail says how many are left. What .3mf has no
/// place for is a note. Nothing is renamed into place; `outputs.commit()` does that.
/// @throw Error as validate and requireModel (vdb/level_set.h); Io, EmptyInput (no surface to mesh)
/// @par Repeats byte for byte for equal models and metadata
void writeModel(const LevelSet& model, const std::vector<std::string>& paths,
                const ModelOutputOptions& options, OutputSet& outputs, const RunContext& ctx = {});

}  // namespace vdbsynth
