#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/volume_file.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

/// What the samples of a volume hold.
enum class VolumeValues {
    Inside,    ///< uint8: 1 in the solid, 0 outside
    Distance,  ///< float32 [world]: the level set's values, negative inside, clamped to its band
    Density    ///< float32: fog, 1/2 - distance / (2 voxels) clamped to 0..1; 1/2 at the surface
};

/// The box of a model that a volume holds: a recorded domain, else the solid's box and the half-width of its
/// band (rounded up) around it.
/// @throw Error EmptyInput (no inside)
IndexBox volumeBox(const LevelSet& model);
/// A model's volume: one sample a voxel of its box, at the voxel's place; its unit if its file named one.
VolumeHead volumeHeadOf(const LevelSet& model, VolumeValues values);

/// Writes a model as a volume, a slab at a time. What its format has no place for, solid voxels outside a
/// recorded domain, and for .npy where its first voxel lies are notes.
/// @param path       named in messages; its extension is one of volumeFormatOf's
/// @param temporary  the file to write
/// @throw Error as volumeBox and writeVolume (io/volume_file.h)
/// @par Repeats byte for byte for equal models
void writeModelVolume(const LevelSet& model, const std::string& path, const std::string& temporary,
                      VolumeValues values, const RunContext& ctx = {});

}  // namespace vdbsynth
