#pragma once
#include "python/vdbsynth/grid_arrays.h"

#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster_options.h"
#include "libvdbsynth/vdb/level_set.h"

#include <vector>

namespace vdbsynth::python {

/// Numbers of a box of voxels [x, y, z], z fastest, borrowed.
struct ArrayView {
    const float* values = nullptr;
    Index3 size;
};

/// Signed distances [world], negative inside, of a texture that continues beyond the array as its last layer
/// does: the array's box is the recorded domain, capped half a voxel outside it.
/// @throw Error BadData (NaN or infinite), EmptyInput (no surface), as requirePlace
/// @par Repeats same bits for any number of threads
LevelSet textureOfArray(const ArrayView& distances, const ArrayPlace& place, double halfWidth,
                        const RunContext& ctx);

/// A volume of any values as the solid that options say (raster/volume_field.h), like a file of a volume.
/// @throw Error as volumeField
/// @par Repeats same bits for any number of threads
LevelSet solidOfVolume(const ArrayView& values, const ArrayPlace& place, const VolumeOptions& options,
                       double halfWidth, const RunContext& ctx);

/// The voxels that describe a model: those of its band and of its domain.
IndexBox boxOf(const LevelSet& model);

/// The model with another domain, its grid stamped with it; the tree is shared.
/// @throw Error as requireBox
LevelSet withDomain(const LevelSet& model, const IndexBox& domain, bool recorded);

}  // namespace vdbsynth::python
