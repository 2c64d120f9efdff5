#pragma once
#include "libvdbsynth/raster/raster.h"
#include "libvdbsynth/texture/surface_texture.h"

namespace vdbsynth::test {

/// A picture as a sample, its rows from the bottom, its values over its white.
SampleImage sampleOf(const Raster& raster);

/// Each number is a ratio to the sample itself.
struct TextureNumbers {
    /// Largest over the channels of the Wasserstein distance between the result's values and the sample's,
    /// over the median of that of 30 draws of as many texels in random windows of 32 texels.
    double histogram = 0;
    /// Mean difference of neighbours' colours, over that of the sample's places at the same differences.
    double steps = 0;
    /// Mean difference of neighbours' colours where their coordinates do not continue, over that of the
    /// sample at the same differences.
    double seams = 0;
    /// Sliced Wasserstein distance of irregular neighbourhoods of 25 points to the sample read through the
    /// same neighbourhoods anywhere, over that of one half of the sample to the other (mean of both ways to
    /// halve it).
    double patches = 0;
    double wide = 0;      ///< the same of 25 among the nearest 225
    double coherent = 0;  ///< share of pairs of neighbours whose coordinates continue each other
};

TextureNumbers textureNumbers(const TextureTarget& target, const TexturedSites& result,
                              const SampleImage& sample, double texel, const RunContext& ctx);

}  // namespace vdbsynth::test
