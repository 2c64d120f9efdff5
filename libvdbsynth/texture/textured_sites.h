#pragma once
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/math/vec3.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

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
