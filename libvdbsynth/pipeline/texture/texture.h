#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/texture/texture_sample.h"
#include "libvdbsynth/pipeline/texture/texture_target.h"
#include "libvdbsynth/texture/corner_coordinates.h"
#include "libvdbsynth/texture/surface_texture.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// How to texture: by surface coordinate synthesis, or as one of the paper's three methods [zhang2004].
enum class TextureMethod { Default, Parameterize, Match, Hybrid };

struct TextureOptions {
    TextureMethod method = TextureMethod::Default;
    double scale = 1;  ///< 0.01..100: 2 makes the texture twice as large. At 1 a texel is the mean distance
                       ///< of a site to its nearest.
    std::optional<DirectionSource> direction;    ///< of the sample's u axis over the target; none: free
    CoordinateOptions synthesis;                 ///< of the default method
    SampleBlend blend = SampleBlend::Automatic;  ///< `match` and `hybrid` mix nothing
    double regionBlend = 0;  ///< 0..1000 [texels], of the default method: how far from borders between
                             ///< regions colours cross-fade (texture/region_blend.h)
    int neighbours = 25;     ///< 4..128, of the paper's methods
    int levels = 0;          ///< 1..12, of the sample's pyramid; 0: as many as fit
    bool coherent = false;   ///< of `match`: only candidates that continue neighbours
    int matchSample = 0;  ///< [texels] side of the part of the sample that `hybrid` matches in; 0: all of it
};

/// @throw Error InvalidOption (a field out of its range, a direction without its grid or strokes)
void validate(const TextureOptions& options);

/// What texturing made of a target.
struct TextureResult {
    TexturedSites sites;
    double texel = 1;                          ///< [world]
    bool smooth = true;                        ///< values were read between texels, else from the nearest
    std::vector<CoordinateLevelStats> levels;  ///< coarse to fine, of the default method
};

/// Textures a target.
/// @param labels  [sites] number of the sample that each takes; empty: 0 everywhere
/// @throw Error as validate and textureSurface (texture/surface_texture.h); Unusable (a direction that cannot
/// be had from this target)
/// @par Repeats same bits for any number of threads
TextureResult textureShape(const TextureShape& shape, const std::vector<TextureSample>& samples,
                           const std::vector<std::int32_t>& labels, const TextureOptions& options,
                           const RunContext& ctx = {});

/// Moves all elements along their sites' normals by `amplitude` times a map's value (its first channel), and
/// fills TextureShape::moved. Coordinates stay.
/// @param amplitude  [world]   @throw Error InvalidOption (no such map, an amplitude too large)
void displace(TextureShape& shape, const TextureResult& result, const std::vector<TextureSample>& samples,
              const std::string& map, double amplitude);

/// Views for corner coordinates and extension (texture/corner_coordinates.h); borrows everything.
std::vector<SampleImage> imagesOf(const std::vector<TextureSample>& samples);

}  // namespace vdbsynth
