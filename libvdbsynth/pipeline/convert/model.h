#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster_options.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/level_set.h"

#include <optional>
#include <string>

namespace vdbsynth {

struct ModelOptions {
    double voxelSize = 0;  ///< [world], above 0; 0: by resolution. A VDB is resampled.
    int resolution = 0;    ///< voxels along the mesh's longest side, 2..100000; 0: kDefaultResolution, with a
                           ///< note. A VDB is resampled.
    double halfWidth = 3;  ///< [voxels] of the level set made from a mesh, 1.5..100
    SolidOptions solid;    ///< how to treat meshes that are not watertight
    std::string grid;      ///< which grid of a VDB file or array of a raster file; empty: see VdbReadOptions
                           ///< and RasterReadOptions
    std::optional<double> iso;  ///< makes a fog volume a solid
    HeightOptions heights;      ///< of images; its voxel size and resolution are those above
    VolumeOptions volume;       ///< of volumes
    bool carry = false;         ///< fills LevelSet::attributes from a VDB's other grids, or the attributes of
                                ///< vertices and points
    bool keepSource = false;    ///< keeps a mesh in LevelSet::source
    /// The file's unit in that of the result: 1000 reads metres as millimetres. Multiplies all coordinates,
    /// above 0. Sizes in these options are in the result's unit.
    double unitScale = 1;
    bool imageAsVolume = false;  ///< reads an image as a volume of one slice
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ModelOptions& options);

inline constexpr int kDefaultResolution = 128;

/// True if the path's extension is one that loadModel reads.
bool isModelPath(const std::string& path);
bool isMeshPath(const std::string& path);

/// @throw Error InvalidOption if the extension is unknown; the message lists the known ones
void requireModelPath(const std::string& path);

/// Any supported geometry as a level set; every command reads models through this function.
/// @throw Error  as validate, readVdbModel (vdb/vdb_file.h), readMesh (io/mesh_file.h), readRaster
/// (io/raster_file.h), heightField (raster/height_field.h), volumeField (raster/volume_field.h) and
/// meshToSolid (vdb/convert/mesh_to_level_set.h)
/// @par Repeats  same bits for any number of threads
LevelSet loadModel(const std::string& path, const ModelOptions& options = {}, const RunContext& ctx = {});

/// The model with a band of `halfWidth` voxels a side: unchanged if it has that, else
/// recomputed from its zero level.
/// @throw Error InvalidOption (`halfWidth`), EmptyInput (no surface)
LevelSet withHalfWidth(const LevelSet& model, double halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
