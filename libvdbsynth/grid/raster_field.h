#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/grid/raster.h"
#include "libvdbsynth/grid/raster_options.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {

/// A field whose zero level is a surface, negative inside, in no unit; and the domain it was made for. The
/// field goes some voxels beyond the domain, where the outermost samples go on.
struct RasterField {
    BrickField field;
    IndexBox domain;
    double voxelSize = 1;     ///< [world]
    Vec3d origin{0, 0, 0};    ///< [world] of voxel 0,0,0
    std::string description;  ///< what was decided, one line
};

inline constexpr float kRasterFieldLimit = 4.f;  ///< largest value of the fields here
inline constexpr int kRasterFieldMargin = 6;     ///< voxels that they go beyond the domain

/// @throw Error InvalidOption (a field out of its range)
void validate(const HeightOptions& options);

/// A height field as a slab. The zero level lies on the bilinear surface through the heights at the voxels'
/// centres. At other voxel sizes heights are averaged (tent filter) or interpolated (Catmull-Rom). Pixels
/// without data are holes through the slab. Black, or a real height of 0, is 0 along the height's axis.
/// @param name  begins the messages
/// @throw Error InvalidOption, BadData (infinite values), EmptyInput (no data), Unusable (no height to tell),
/// Memory
/// @par Cost    O(pixels + bricks of the domain)   @par Repeats same bits for any number of threads
RasterField heightField(const std::string& name, const Raster& raster, const HeightOptions& options = {},
                        const RunContext& ctx = {});

/// Heights as an image of whole rows from the top; NaN where a column meets no surface from above.
struct HeightImage {
    int columns = 0, rows = 0;
    std::vector<float> heights;  ///< [rows x columns] voxels above voxel 0 along the height's axis
};

/// The topmost surface of each column of voxels of a field, as heightField would have it; where the solid
/// reaches the field's top, half a voxel above that.
/// @par Cost    O(voxels of the domain that are not in constant bricks)   @par Repeats yes
HeightImage topHeights(const BrickField& field, HeightPlane plane, const RunContext& ctx = {});

/// @throw Error InvalidOption (a field out of its range, both a threshold and labels)
void validate(const VolumeOptions& options);

/// A volume as a field at its own resolution; cells that are no cubes are resampled (trilinear) to their
/// smallest side. With a threshold the surface is that of trilinear interpolation. With labels, or for a
/// volume of only two values (the larger is solid then), the steps between voxels are smoothed under the
/// constraint that every sample stays on its side [whitaker2000], so volume fractions and thin parts are
/// kept. Samples without data are outside.
/// @throw Error InvalidOption (threshold and labels), BadData (infinite values), EmptyInput, Unusable
/// (neither was given;
///              no surface at the threshold; no sample has such a label), Memory
/// @par Cost    O(samples)   @par Repeats same bits for any number of threads
RasterField volumeField(const std::string& name, const Raster& raster, const VolumeOptions& options = {},
                        const RunContext& ctx = {});

}  // namespace vdbsynth
