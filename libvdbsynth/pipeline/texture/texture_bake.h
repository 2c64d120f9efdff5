#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/io/output_set.h"
#include "libvdbsynth/pipeline/texture/texture.h"
#include "libvdbsynth/pipeline/texture/uv_bake.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// The map that a picture of this name holds: that whose name ends the file's name, before the extension, a
/// <UDIM> and a tile's number (steel_roughness.png, normal.<UDIM>.exr); else the colour.
const SampleMap& bakedMap(const std::string& path, const TextureSample& sample);

/// Bakes a map onto the target's own texture coordinates (attribute `uv`, uv_bake.h): every pixel takes the
/// value at the coordinate that its triangle's corners give there (texture/corner_coordinates.h), by cubic
/// convolution. A map named `normal` is rotated from the sample's axes to those of the target's own
/// coordinates.
/// @param bits  of .png, 8 or 16; .exr holds floats
/// @throw Error Unusable (no `uv`, no face inside, more than 100 tiles), Memory, Io
/// @par Repeats same bits for any number of threads
void bakeTexture(const TextureShape& shape, const TextureResult& result,
                 const std::vector<TextureSample>& samples, const std::string& path, int size, int bits,
                 OutputSet& outputs, const RunContext& ctx = {});

}  // namespace vdbsynth
