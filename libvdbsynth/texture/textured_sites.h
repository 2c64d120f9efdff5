#pragma once
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// How colours are mixed where pieces of a sample meet.
enum class SampleBlend {
    Automatic,  ///< Histogram where the sample is stochastic (blendLoss in histogram_blend.h at most
                ///< kBlendSuits); else Off, or Weight where something has to be mixed
    Off,        ///< not at all: every colour is one of the sample's
    Weight,     ///< mean by weight [zhang2004, 3.4], which loses contrast
    Histogram   ///< keeps the sample's histogram (histogram_blend.h)
};

/// What texturing gives every site of a surface. The coordinates are the result; the values follow from them
/// but where they are blended.
struct TexturedSites {
    static constexpr std::int32_t kNone = -1;

    std::vector<std::int32_t> sample;  ///< [sites] number of the sample; kNone: no colour
    std::vector<Vec2f> coordinate;  ///< [sites] in texels of the sample (sample_image.h); may lie beyond it
                                    ///< where the sample is tileable
    std::vector<Vec3f>
        tangent;  ///< [sites] on the surface, length 1, the direction of +u; +v is normal x tangent
    std::vector<float> values;  ///< [sites x channels]
    /// [sites] nonzero where `values` are a mix of several places of the sample, of which `coordinate` is the
    /// one with the largest weight.
    std::vector<char> blended;
};

}  // namespace vdbsynth
