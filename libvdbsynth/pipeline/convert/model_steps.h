#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/raster/raster.h"
#include "libvdbsynth/raster/raster_field.h"

#include <cstddef>
#include <string>

namespace vdbsynth {

/// A note for each option that is for another kind of file than this one: with several inputs it may be for
/// another of them.
void noteUnusedOptions(const std::string& path, const ModelOptions& options, const RunContext& ctx);

/// A warning if pixels of an image lie farther than a voxel from the surface.
/// @throw Error Unusable (over half of them)
void sayLostHeights(const std::string& path, const Raster& raster, const RasterField& field,
                    const RunContext& ctx);

/// A note if a volume's parts came apart in the level set, by over a tenth more of them; a warning from twice
/// as many on.
void sayBrokenParts(const std::string& path, std::size_t before, std::size_t after, const RunContext& ctx);

/// sayBrokenParts, where samples that touch by edges or corners are one part; and
/// a note if the level set of a volume of two sides has another volume than its solid samples by over 1 %, a
/// warning from 5 % on. Every sample is on its side, so it is no error.
/// @param grid  [voxels] of the field
void sayLostSamples(const std::string& path, const RasterField& field, const openvdb::FloatGrid& grid,
                    const RunContext& ctx);

}  // namespace vdbsynth
