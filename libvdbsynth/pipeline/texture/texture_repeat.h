#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/texture/texture.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A sample as a textured file remembers it.
struct RememberedSample {
    std::string name;
    int width = 0, height = 0;
    bool tileable = false;
};

/// A textured file as texture writes it: the target with the coordinates that were found for it.
struct TextureMap {
    TextureShape shape;
    TextureResult result;  ///< without values
    std::vector<RememberedSample> samples;
    std::vector<std::string> maps;  ///< names of further maps
};

/// True if a path is a .ply with the coordinates of a texture. @throw Error Io
bool isTextureMap(const std::string& path);

/// The lines that texture writes into its files for readTextureMap.
std::vector<std::string> sampleComments(const TextureResult& result,
                                        const std::vector<TextureSample>& samples);

/// Reads a textured .ply, points or mesh.
/// @throw Error as readMesh and readPoints; BadData (missing or invalid coordinates or samples)
TextureMap readTextureMap(const std::string& path, const RunContext& ctx = {});

/// Gives the coordinates of a map to other samples of the same layout: a sample of another size is read at
/// coordinates scaled by the ratio of their sizes, said in a note; it is tileable where the map's was. Fills
/// TextureMap::result.
/// @throw Error ShapeMismatch (another number of samples than the map's)
/// @par Repeats same bits for any number of threads
void repeatTexture(TextureMap& map, std::vector<TextureSample>& samples, const RunContext& ctx = {});

}  // namespace vdbsynth
