#include "libvdbsynth/relief/gaussian_mean.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

// Weights from -radius to radius, of sum one.
std::vector<float> weightsOf(double sigma) {
    if (sigma < 0.7) {
        const double beside = sigma * sigma / 2;
        return {float(beside), float(1 - 2 * beside), float(beside)};
    }
    const int radius = int(std::ceil(4 * sigma));
    std::vector<double> exact;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
        exact.push_back(exponential(-0.5 * i * i / (sigma * sigma)));
        sum += exact.back();
    }
    std::vector<float> weights;
    for (const double weight : exact) weights.push_back(float(weight / sum));
    return weights;
}

// A brick's samples from those of the brick and `radius` to either side along one axis.
void sumAlong(int axis, const std::vector<float>& weights, const float* in, float* out) {
    const int length = kSide + int(weights.size()) - 1;
    const int outer = axis == 0 ? 1 : axis == 1 ? kSide : kSide * kSide;
    const int inner = BrickField::kSamples / kSide / outer;  // samples that follow each other
    std::fill_n(out, BrickField::kSamples, 0.f);
    for (int o = 0; o < outer; ++o)
        for (int i = 0; i < kSide; ++i) {
            float* to = out + (o * kSide + i) * inner;
            const float* from = in + (o * length + i) * inner;
            for (const float weight : weights) {
                for (int k = 0; k < inner; ++k) to[k] += weight * from[k];
                from += inner;
            }
        }
}

// Along z, where the samples that follow each other are those to be summed.
void sumAlongZ(const std::vector<float>& weights, const float* in, float* out) {
    const int length = kSide + int(weights.size()) - 1;
    for (int row = 0; row < kSide * kSide; ++row, in += length, out += kSide) {
        float sums[kSide] = {};
        const float* from = in;
        for (const float weight : weights) {
            for (int k = 0; k < kSide; ++k) sums[k] += weight * from[k];
            ++from;
        }
        std::copy_n(sums, kSide, out);
    }
}

BrickField meanAlong(const BrickField& field, int axis, const std::vector<float>& weights,
                     const RunContext& ctx) {
    const int radius = int(weights.size()) / 2;
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        IndexBox region = brick;
        region.min[axis] -= radius;
        region.max[axis] += radius;
        float constant = 0;
        if (field.constantIn(region, constant)) {
            std::fill_n(samples, BrickField::kSamples, constant);
            return;
        }
        thread_local std::vector<float> values;
        values.resize(std::size_t(region.volume()));
        field.readBox(region.min, region.size(), values.data());
        if (axis == 2)
            sumAlongZ(weights, values.data(), samples);
        else
            sumAlong(axis, weights, values.data(), samples);
    });
}

}  // namespace

BrickField gaussianMean(const BrickField& field, double sigma, const RunContext& ctx) {
    requireOption(sigma >= 0 && sigma <= 2000, "sigma", roundedText(sigma, 6), "from 0 to 2000 [voxels]");
    if (sigma == 0) return field;
    const std::vector<float> weights = weightsOf(sigma);
    return meanAlong(meanAlong(meanAlong(field, 2, weights, ctx), 1, weights, ctx), 0, weights, ctx);
}

}  // namespace vdbsynth
