#pragma once
#include "libvdbsynth/pipeline/texture/texture_outputs.h"

namespace vdbsynth {

/// Coordinates of a target's corners.
CornerCoordinates cornersOf(const TextureShape& shape, const TextureResult& result,
                            const std::vector<SampleImage>& images, const RunContext& ctx);

/// The lines that texture_repeat.h reads.
std::vector<std::string> sampleComments(const TextureResult& result,
                                        const std::vector<TextureSample>& samples);

/// .ply, .obj, .off, .glb, .gltf, .3mf. @param path  for messages and the format
void writeTexturedMesh(const TextureShape& shape, const TextureResult& result,
                       const std::vector<TextureSample>& samples, const std::string& path,
                       const std::string& temporary, const RunContext& ctx);

void writeTexturedVdb(const TextureShape& shape, const TextureResult& result,
                      const std::vector<TextureSample>& samples, const std::string& temporary,
                      const TextureOutputOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
