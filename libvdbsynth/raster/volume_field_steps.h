#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/raster/raster.h"
#include "libvdbsynth/raster/raster_field.h"

#include <string>

namespace vdbsynth {

/// Gives a field on a raster's samples its voxels, which are cubes: those samples, or resampled ones where
/// their cells are longer than wide or sheared; the description says so.
/// @param cell       [world] sides of a sample's cell
/// @param inPlace    the field lies at the raster's origin; false: at zero
/// @throw Error Unusable (cells over 1e8 times as long as wide), Memory
void placeField(const std::string& name, const Raster& raster, const Vec3d& cell, bool inPlace,
                RasterField& result, const RunContext& ctx);

}  // namespace vdbsynth
