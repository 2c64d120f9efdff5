#include "libvdbsynth/coordinates/sample_image.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Weights of the four texels around, at a share t of the way from the second to the third.
void cubicWeights(float t, float* w) {
    const float t2 = t * t, t3 = t2 * t;
    w[0] = -0.5f * t3 + t2 - 0.5f * t;
    w[1] = 1.5f * t3 - 2.5f * t2 + 1;
    w[2] = -1.5f * t3 + 2 * t2 + 0.5f * t;
    w[3] = 0.5f * t3 - 0.5f * t2;
}

}  // namespace

int largestSquare(const SampleImage& image) {
    if (image.valid.empty()) return std::min(image.width, image.height);
    // Of every texel the side of the largest square that ends there, from the three before it.
    std::vector<int> row(std::size_t(image.width), 0);
    int largest = 0;
    for (int y = 0; y < image.height; ++y) {
        int diagonal = 0;
        for (int x = 0; x < image.width; ++x) {
            const int above = row[std::size_t(x)];
            const int left = x > 0 ? row[std::size_t(x - 1)] : 0;
            const bool valid = image.valid[std::size_t(y) * std::size_t(image.width) + std::size_t(x)] != 0;
            row[std::size_t(x)] = valid ? 1 + std::min({above, left, x > 0 ? diagonal : 0}) : 0;
            diagonal = above;
            largest = std::max(largest, row[std::size_t(x)]);
        }
    }
    return largest;
}

const float* nearestTexel(const SampleImage& image, const Vec2f& at) {
    return image.texel(foldedTexel(int(std::floor(at.x)), image.width, image.tileable),
                       foldedTexel(int(std::floor(at.y)), image.height, image.tileable));
}

void readLinear(const SampleImage& image, const Vec2f& at, float* out) {
    const float x = at.x - 0.5f, y = at.y - 0.5f;
    const float left = std::floor(x), low = std::floor(y);
    const float tx = x - left, ty = y - low;
    const int x0 = foldedTexel(int(left), image.width, image.tileable);
    const int x1 = foldedTexel(int(left) + 1, image.width, image.tileable);
    const int y0 = foldedTexel(int(low), image.height, image.tileable);
    const int y1 = foldedTexel(int(low) + 1, image.height, image.tileable);
    const float *a = image.texel(x0, y0), *b = image.texel(x1, y0), *c = image.texel(x0, y1),
                *d = image.texel(x1, y1);
    for (int k = 0; k < image.channels; ++k) {
        const float lower = a[k] + (b[k] - a[k]) * tx, upper = c[k] + (d[k] - c[k]) * tx;
        out[k] = lower + (upper - lower) * ty;
    }
}

void readCubic(const SampleImage& image, const Vec2f& at, float* out) {
    const float x = at.x - 0.5f, y = at.y - 0.5f;
    const int left = int(std::floor(x)), low = int(std::floor(y));
    float wx[4], wy[4];
    cubicWeights(x - float(left), wx);
    cubicWeights(y - float(low), wy);
    const float* texels[4][4];
    for (int j = 0; j < 4; ++j) {
        const int row = foldedTexel(low - 1 + j, image.height, image.tileable);
        for (int i = 0; i < 4; ++i)
            texels[j][i] = image.texel(foldedTexel(left - 1 + i, image.width, image.tileable), row);
    }
    for (int k = 0; k < image.channels; ++k) {
        float sum = 0;
        for (int j = 0; j < 4; ++j) {
            float row = 0;
            for (int i = 0; i < 4; ++i) row += wx[i] * texels[j][i][k];
            sum += wy[j] * row;
        }
        const float a = texels[1][1][k], b = texels[1][2][k], c = texels[2][1][k], d = texels[2][2][k];
        out[k] = std::clamp(sum, std::min(std::min(a, b), std::min(c, d)),
                            std::max(std::max(a, b), std::max(c, d)));
    }
}

}  // namespace vdbsynth
