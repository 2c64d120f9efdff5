#pragma once
#include "libvdbsynth/math/vec2.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// A flat sample of a texture: any number of channels on a lattice of texels. Coordinates are in texels from
/// the lower left corner, u to the right, v up: texel (x, y) covers [x, x + 1] x [y, y + 1], its centre is at
/// (x + 0.5, y + 0.5).
struct SampleImage {
    int width = 0, height = 0, channels = 0;
    bool tileable = false;      ///< continues at its opposite border; else mirrored there
    std::vector<float> values;  ///< [height x width x channels], the lowest row first
    /// [height x width] 0 where nothing may be copied from, as between the charts of an atlas; values there
    /// only continue those around. Empty: all is good.
    std::vector<char> valid{};

    std::size_t texels() const { return std::size_t(width) * std::size_t(height); }
    const float* texel(int x, int y) const { return values.data() + offset(x, y); }
    float* texel(int x, int y) { return values.data() + offset(x, y); }
    std::size_t offset(int x, int y) const {
        return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(channels);
    }
};

/// The lattice index of a texel outside 0..size-1: wrapped or mirrored (-1 is 0).
inline int foldedTexel(int x, int size, bool wraps) {
    if (x >= 0 && x < size) return x;
    const int period = wraps ? size : 2 * size;
    x %= period;
    if (x < 0) x += period;
    return x < size ? x : period - 1 - x;
}

/// [texels] side of the largest square of valid texels; the shorter side of an image without a mask.
int largestSquare(const SampleImage& image);

/// The nearest texel's values at a coordinate. @return [channels], valid as long as the image
const float* nearestTexel(const SampleImage& image, const Vec2f& at);

/// The values between texels, linear in both axes. @param out  [channels]
void readLinear(const SampleImage& image, const Vec2f& at, float* out);

/// By cubic convolution (Catmull-Rom), which keeps more of the contrast of fine texture than readLinear, held
/// to the range of the four texels around, so that it never overshoots. @param out  [channels]
void readCubic(const SampleImage& image, const Vec2f& at, float* out);

}  // namespace vdbsynth
