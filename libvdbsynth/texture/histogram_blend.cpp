#include "libvdbsynth/texture/histogram_blend.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/texture/point_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr std::size_t kTable = 2048;
constexpr double kWidest = 4.5;  // the table covers -kWidest..kWidest

// Replaces one component of all texels by normal values of its rank, and tabulates the way back.
void makeNormal(SampleImage& image, int component, float* table) {
    const std::size_t n = image.texels(), step = std::size_t(image.channels);
    float* values = image.values.data() + component;
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const float x = values[a * step], y = values[b * step];
        return x != y ? x < y : a < b;
    });
    std::vector<float> sorted(n), normal(n);
    for (std::size_t r = 0; r < n; ++r) sorted[r] = values[order[r] * step];
    for (std::size_t first = 0, last = 0; first < n; first = last) {
        while (last < n && sorted[last] == sorted[first]) ++last;
        const double rank = 0.5 * double(first + last);
        for (std::size_t r = first; r < last; ++r) normal[r] = float(normalQuantile(rank / double(n)));
    }
    for (std::size_t r = 0; r < n; ++r) values[order[r] * step] = normal[r];
    std::size_t above = 0;
    for (std::size_t k = 0; k < kTable; ++k) {
        const float g = float(kWidest * (2 * double(k) / double(kTable - 1) - 1));
        while (above < n && normal[above] < g) ++above;
        if (above == 0 || above == n) {
            table[k] = sorted[above == 0 ? 0 : n - 1];
            continue;
        }
        const float low = normal[above - 1], share = (g - low) / (normal[above] - low);
        table[k] = sorted[above - 1] + (sorted[above] - sorted[above - 1]) * share;
    }
}

}  // namespace

double normalQuantile(double share) {
    // Acklam's rational approximation.
    static constexpr std::array<double, 6> a{-3.969683028665376e+01, 2.209460984245205e+02,
                                             -2.759285104469687e+02, 1.383577518672690e+02,
                                             -3.066479806614716e+01, 2.506628277459239e+00};
    static constexpr std::array<double, 5> b{-5.447609879822406e+01, 1.615858368580409e+02,
                                             -1.556989798598866e+02, 6.680131188771972e+01,
                                             -1.328068155288572e+01};
    static constexpr std::array<double, 6> c{-7.784894002430293e-03, -3.223964580411365e-01,
                                             -2.400758277161838e+00, -2.549732539343734e+00,
                                             4.374664141464968e+00,  2.938163982698783e+00};
    static constexpr std::array<double, 4> d{7.784695709041462e-03, 3.224671290700398e-01,
                                             2.445134137142996e+00, 3.754408661907416e+00};
    constexpr double kTail = 0.02425, kLn2 = 0.69314718055994530942;
    if (share > 0.5) return -normalQuantile(1 - share);
    if (share < kTail) {
        const double q = std::sqrt(-2 * kLn2 * logarithm2(share));
        return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
               ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1);
    }
    const double q = share - 0.5, r = q * q;
    return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
           (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1);
}

HistogramBlend::HistogramBlend(const SampleImage& sample, const RunContext& ctx) {
    requireSample(sample);
    const std::size_t channels = std::size_t(sample.channels), n = sample.texels();
    mAxes = principalAxes(sample.values, channels, channels, 1.0);
    mGaussian.width = sample.width;
    mGaussian.height = sample.height;
    mGaussian.channels = int(mAxes.count);
    mGaussian.tileable = sample.tileable;
    mGaussian.values.resize(n * mAxes.count);
    for (std::size_t i = 0; i < n; ++i)
        mAxes.project(sample.values.data() + i * channels, mGaussian.values.data() + i * mAxes.count);
    mInverse.resize(mAxes.count * kTable);
    for (std::size_t k = 0; k < mAxes.count; ++k) {
        throwIfCancelled(ctx);
        makeNormal(mGaussian, int(k), mInverse.data() + k * kTable);
    }
}

void HistogramBlend::mix(const BlendPart* parts, std::size_t count, float* out) const {
    constexpr std::size_t kFew = 16;
    std::array<float, 2 * kFew> few;
    std::vector<float> many;
    float* sum = few.data();
    if (mAxes.count > kFew) {
        many.resize(2 * mAxes.count);
        sum = many.data();
    }
    float* read = sum + mAxes.count;
    std::fill_n(sum, mAxes.count, 0.f);
    float squares = 0;
    for (std::size_t i = 0; i < count; ++i) {
        readCubic(mGaussian, parts[i].at, read);
        squares += parts[i].weight * parts[i].weight;
        for (std::size_t k = 0; k < mAxes.count; ++k) sum[k] += parts[i].weight * read[k];
    }
    const float scale = squares > 0 ? 1 / std::sqrt(squares) : 0;
    std::copy(mAxes.mean.begin(), mAxes.mean.end(), out);
    for (std::size_t k = 0; k < mAxes.count; ++k) {
        const float* table = mInverse.data() + k * kTable;
        const float at = std::clamp((sum[k] * scale / float(kWidest) + 1) * 0.5f * float(kTable - 1), 0.f,
                                    float(kTable - 1));
        const std::size_t low = std::min(std::size_t(at), kTable - 2);
        const float value = table[low] + (table[low + 1] - table[low]) * (at - float(low));
        for (std::size_t c = 0; c < mAxes.length; ++c) out[c] += value * mAxes.axes[k * mAxes.length + c];
    }
}

}  // namespace vdbsynth
