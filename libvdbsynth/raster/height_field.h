#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster.h"
#include "libvdbsynth/raster/raster_field.h"
#include "libvdbsynth/raster/raster_options.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// @throw Error InvalidOption (a field out of its range)
void validate(const HeightOptions& options);

/// A height field as a slab. The zero level lies on the bilinear surface through the heights at the voxels'
/// centres. At other voxel sizes heights are averaged (tent filter) or interpolated (Catmull-Rom). Pixels
/// without data are holes through the slab. Black, or a real height of 0, is at 0 along the height's axis.
/// @param name  begins the messages
/// @throw Error InvalidOption, BadData (infinite values), EmptyInput (no data), Unusable
/// (undetermined height), Memory
/// @par Cost    O(pixels + bricks of the domain)   @par Repeats same bits for any number of threads
RasterField heightField(const std::string& name, const Raster& raster, const HeightOptions& options = {},
                        const RunContext& ctx = {});

/// Heights as an image of whole rows from the top; NaN where a column meets no surface from above.
struct HeightImage {
    int columns = 0, rows = 0;
    std::vector<float> heights;  ///< [rows x columns] voxels above voxel 0 along the height's axis
};

/// The topmost surface of each column of voxels of a field, the inverse of heightField; half a voxel above
/// the field's top where the solid reaches that.
/// @par Cost    O(voxels of the domain that are not in constant bricks)   @par Repeats yes
HeightImage topHeights(const BrickField& field, HeightPlane plane, const RunContext& ctx = {});

}  // namespace vdbsynth
