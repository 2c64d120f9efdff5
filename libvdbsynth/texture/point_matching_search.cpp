#include "libvdbsynth/texture/point_matching_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Adds terms to the costs of kBlock texels beginning at `at`, until all are above `most`.
// @return false if they are
__attribute__((target_clones("avx2", "default"))) bool addTerms(const MatchTerm* terms, std::size_t count,
                                                                std::ptrdiff_t at, float most,
                                                                float* __restrict costs) {
    constexpr std::size_t kBetween = 6;  // terms between looks at the best
    float sum[kBlock] = {};
    for (std::size_t first = 0; first < count; first += kBetween) {
        const std::size_t last = std::min(count, first + kBetween);
        for (std::size_t t = first; t < last; ++t) {
            const float* values = terms[t].plane + at;
            const float value = terms[t].value;
            for (int i = 0; i < kBlock; ++i) {
                const float d = values[i] - value;
                sum[i] += d * d;
            }
        }
        int alive = 0;
        for (int i = 0; i < kBlock; ++i) alive |= sum[i] <= most;
        if (!alive) return false;
    }
    for (int i = 0; i < kBlock; ++i) costs[i] = sum[i];
    return true;
}

}  // namespace

MatchPlanes::MatchPlanes(const SampleImage& image, int margin, bool all)
    : mMargin(margin),
      mChannels(image.channels),
      mStride(image.width + 2 * margin + kBlock),
      mRows(image.height + 2 * margin + 1),
      mAll(all),
      mBase(planeSize() * std::size_t(image.channels)) {
    for (int c = 0; c < mChannels; ++c)
        for (std::ptrdiff_t y = 0; y < mRows; ++y)
            for (std::ptrdiff_t x = 0; x < mStride; ++x)
                mBase[std::size_t((c * mRows + y) * mStride + x)] =
                    image.texel(foldedTexel(int(x) - margin, image.width, image.tileable),
                                foldedTexel(int(y) - margin, image.height, image.tileable))[c];
    if (!all) return;
    mPhases.resize(planeSize() * std::size_t(kPhases * kPhases * mChannels));
    for (int phase = 0; phase < kPhases * kPhases; ++phase)
        for (int c = 0; c < mChannels; ++c)
            compute(phase % kPhases, phase / kPhases, c,
                    mPhases.data() + std::size_t(phase * mChannels + c) * planeSize());
}

double MatchPlanes::bytes(const SampleImage& image, int margin) {
    return double(image.width + 2 * margin + kBlock) * double(image.height + 2 * margin + 1) *
           double(image.channels) * (kPhases * kPhases) * sizeof(float);
}

void MatchPlanes::compute(int phaseX, int phaseY, int channel, float* out) const {
    const float* base = mBase.data() + std::size_t(channel) * planeSize();
    const float tx = float(phaseX) / kPhases, ty = float(phaseY) / kPhases;
    const std::size_t last = planeSize() - std::size_t(mStride) - 1;  // beyond it nothing is asked for
    for (std::size_t i = 0; i < last; ++i) {
        const float *a = base + i, *c = a + mStride;
        const float lower = a[0] + (a[1] - a[0]) * tx, upper = c[0] + (c[1] - c[0]) * tx;
        out[i] = lower + (upper - lower) * ty;
    }
}

const float* MatchPlanes::plane(int x8, int y8, int channel, std::vector<float>& room) const {
    const int phaseX = x8 & (kPhases - 1), phaseY = y8 & (kPhases - 1);
    const std::ptrdiff_t x = (x8 - phaseX) / kPhases + mMargin, y = (y8 - phaseY) / kPhases + mMargin;
    const float* values;
    if (mAll) {
        values =
            mPhases.data() + std::size_t((phaseY * kPhases + phaseX) * mChannels + channel) * planeSize();
    } else {
        room.resize(planeSize());
        compute(phaseX, phaseY, channel, room.data());
        values = room.data();
    }
    return values + y * mStride + x;
}

float matchCost(const std::vector<MatchTerm>& terms, std::ptrdiff_t at) {
    float sum = 0;
    for (const MatchTerm& term : terms) {
        const float d = term.plane[at] - term.value;
        sum += d * d;
    }
    return sum;
}

void matchAll(const std::vector<MatchTerm>& terms, std::ptrdiff_t stride, int width,
              const MatchWindow& window, MatchBest& best) {
    float costs[kBlock];
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; x += kBlock) {
            if (!addTerms(terms.data(), terms.size(), y * stride + x, best.cost, costs)) continue;
            const int count = std::min(kBlock, window.x1 - x);
            for (int i = 0; i < count; ++i) best.offer(costs[i], std::int32_t(y * width + x + i));
        }
}

}  // namespace vdbsynth
