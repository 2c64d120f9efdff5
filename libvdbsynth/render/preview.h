#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

struct PreviewOptions {
    int width = 800, height = 600;  ///< [pixels], 16..8192
    Vec3d view{1.0, -1.6,
               0.9};  ///< direction from the model to the camera, not zero; z is up unless it is along z
    GridConstPtr directions;  ///< float vectors near the surface, drawn as streaks along them; null: none
    int samples = 4;          ///< rays per pixel at edges (elsewhere one), 1..64
};

/// @throw Error InvalidOption (a field out of its range), BadData (directions that are not float vectors)
void validate(const PreviewOptions& options);

/// A shaded picture of a level set: a perspective camera that frames the whole solid, one key light with
/// shadow, sky and ground light, edges refined with `samples` rays per pixel. Directions are drawn by line
/// integral convolution [cabral1993]: noise, one number per voxel, averaged along twelve voxels of the field.
/// @throw Error InvalidOption, BadData (directions that are not float vectors), EmptyInput, Cancelled
/// @par Repeats same bits for any number of threads
Picture renderPreview(const openvdb::FloatGrid& grid, const PreviewOptions& options = {},
                      const RunContext& ctx = {});

struct SliceOptions {
    int width = 800, height = 600;  ///< [pixels], 16..8192
    int axis = 2;                   ///< 0, 1, 2: normal of the slice
    double fraction = 0.5;          ///< position in `box` along the axis, 0..1
};

/// @throw Error InvalidOption (a field out of its range, an empty box)
void validate(const SliceOptions& options, const IndexBox& box);

/// A slice through a level set over `box`: inside warm, outside cool, contour lines every voxel of
/// distance, the zero level black.
/// @throw Error InvalidOption
Picture renderSlice(const openvdb::FloatGrid& grid, const IndexBox& box, const SliceOptions& options = {},
                    const RunContext& ctx = {});

}  // namespace vdbsynth
