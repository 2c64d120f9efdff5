#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/raster_options.h"
#include "libvdbsynth/vdb/level_set.h"
#include "libvdbsynth/vdb/mesh_conversion.h"

#include <optional>
#include <string>

namespace vdbsynth {

struct ModelOptions {
    double voxelSize = 0;  ///< [world], above 0; 0: by resolution. A VDB is resampled.
    int resolution = 0;    ///< voxels along the mesh's longest side, 2..100000; 0: kDefaultResolution, with a
                           ///< note. A VDB is resampled.
    double halfWidth = 3;  ///< [voxels] of the level set made from a mesh, 1.5..100
    SolidOptions solid;    ///< what to make of meshes that do not bound a solid
    std::string grid;      ///< which grid of a VDB file; empty: see VdbReadOptions
    std::optional<double> iso;  ///< makes a fog volume a solid
    HeightOptions heights;      ///< of images; its voxel size and resolution are those above
    VolumeOptions volume;       ///< of volumes
    bool carry = false;         ///< fills LevelSet::carried: with a VDB's other grids, with the attributes of
                                ///< vertices and points
    bool keepSource = false;    ///< keeps a mesh in LevelSet::source
    bool imageAsVolume = false;  ///< takes an image for a volume of one slice
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ModelOptions& options);

inline constexpr int kDefaultResolution = 128;

/// True if the path's extension is one that loadModel reads.
bool isModelPath(const std::string& path);
bool isMeshPath(const std::string& path);

/// @throw Error InvalidOption if the extension is unknown, naming the ones that are not
void requireModelPath(const std::string& path);

/// Any supported geometry as a level set: the one door of every command that wants a model.
/// @throw Error  as validate, readVdbModel (vdb/vdb_file.h), readMesh (io/mesh_file.h), readRaster
/// (io/raster_file.h), heightField and volumeField (grid/raster_field.h) and meshToSolid
/// (vdb/mesh_conversion.h)
/// @par Repeats  same bits for any number of threads
LevelSet loadModel(const std::string& path, const ModelOptions& options = {}, const RunContext& ctx = {});

/// The model with a band of `halfWidth` voxels a side: itself if it has that, else re-distanced from its zero
/// level.
/// @throw Error InvalidOption (`halfWidth`), EmptyInput (no surface)
LevelSet withHalfWidth(const LevelSet& model, double halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
