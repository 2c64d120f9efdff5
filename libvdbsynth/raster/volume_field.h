#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster.h"
#include "libvdbsynth/raster/raster_field.h"
#include "libvdbsynth/raster/raster_options.h"

#include <string>

namespace vdbsynth {

/// @throw Error InvalidOption (a field out of its range, two of `threshold`, `below` and `labels`)
void validate(const VolumeOptions& options);

/// A volume as a field at its own resolution; cells that are not cubes are resampled (trilinear) to their
/// smallest side, and sheared ones to cubes along the directions at right angles nearest to theirs. With a
/// threshold, or the value below which it is solid, the surface is that of trilinear interpolation. With
/// labels, or for a volume of only two values (the larger is solid), the steps between voxels are smoothed
/// under the constraint that every sample keeps its sign [whitaker2000], so thin parts are kept; what is few
/// samples thick loses volume (solidVolume tells). Samples without data are outside.
/// @throw Error InvalidOption (two of threshold, below and labels), BadData (infinite values), EmptyInput,
/// Unusable (neither was given; no surface at the threshold; no sample has such a label), Memory
/// @par Cost    O(samples)   @par Repeats same bits for any number of threads
RasterField volumeField(const std::string& name, const Raster& raster, const VolumeOptions& options = {},
                        const RunContext& ctx = {});

}  // namespace vdbsynth
