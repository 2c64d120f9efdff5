#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/texture/textured_sites.h"

#include <vector>

namespace vdbsynth {

/// A surface to texture, given by its points.
struct TextureTarget {
    std::vector<Vec3f> point;         ///< [points] world; some may coincide
    std::vector<Vec3f> normal;        ///< [points] outward, length 1
    std::vector<Vec3f> direction;     ///< [points] given directions of +u, 0 where none; empty: none given
    std::vector<std::int32_t> label;  ///< [points] number of the sample each takes; empty: 0 everywhere
};

/// @throw Error EmptyInput (no points), ShapeMismatch (arrays of different lengths), Unusable (a point or
/// normal that is not finite, a normal of length 0)
void requireTarget(const TextureTarget& target);

/// Sites as sparse as the texels take a texel each; where a texel is over so many spacings wide, samples are
/// read between texels (readCubic).
inline constexpr double kMagnified = 1.5;

inline constexpr double kWidestRegionBlend = 1000;  ///< [texels]

struct SurfaceTextureOptions {
    double texel = 0;  ///< [world] side of a texel on the surface, above 0; 0: the mean distance of a point
                       ///< to its nearest, times `scale`
    double scale = 1;  ///< above 0: 2 makes the texture twice as large
    /// Its `maxRotation` is for targets without directions; where any are given, charts are rotated at most
    /// kGivenRotation from them.
    CoordinateOptions synthesis;
    SampleBlend blend = SampleBlend::Automatic;  ///< where charts meet (seam_blend.h); not Weight
    double regionBlend = 0;  ///< [texels] 0..1000: how far from borders between labels colours cross-fade
                             ///< (region_blend.h); 0: not at all
};

inline constexpr double kGivenRotation = 8;  ///< [degrees]

struct SurfaceTextureResult {
    TexturedSites sites;                       ///< one per point of the target
    double texel = 0;                          ///< [world]
    std::size_t blended = 0;                   ///< number of sites whose colour is a mix where charts meet
    std::size_t regionBlended = 0;             ///< the same where regions meet
    std::vector<CoordinateLevelStats> levels;  ///< coarse to fine
    std::vector<Vec3f> singularities;          ///< [world] of the directions
};

/// Textures a surface by coordinate synthesis (coordinates/coordinate_synthesis.h), the default method.
/// Directions that are not given follow those given, or else are the smoothest field; points that coincide
/// and face the same way are textured as one.
/// @throw Error InvalidOption (a field out of its range), as requireTarget, Unusable (directions only along
/// normals), ShapeMismatch (samples with different numbers of channels, labels without a sample), EmptyInput
/// (an empty sample), Memory, Cancelled
/// @par Cost    O(points log points + texels)
/// @par Repeats same bits for any number of threads
SurfaceTextureResult textureSurface(const TextureTarget& target, const std::vector<SampleImage>& samples,
                                    const SurfaceTextureOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
