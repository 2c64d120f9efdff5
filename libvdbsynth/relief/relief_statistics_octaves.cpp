// Means of heights over the surface, coarser and coarser.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/relief/gaussian_mean.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/relief/relief_statistics_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kLayer = 1.5f;              // [voxels] to either side of the base
constexpr double kFirstWave = 4;            // [voxels] shortest cut-off wavelength
constexpr double kLinearVariance = 1. / 6;  // mean variance that linear interpolation adds, in samples

// Heights times weights, and weights, of which a mean is the quotient of means.
struct Weighted {
    BrickField sum, weight;
};

// A layer may reach farther than is measured.
bool isMeant(const BrickField& base, const ReliefLayer& layer, std::size_t i) {
    return !layer.point[i].lost && std::abs(base.inside(layer.voxels[i])) < kLayer;
}

Weighted weightedHeights(const ReliefLayer& layer, const BrickField& base, const RunContext& ctx) {
    const auto fieldOf = [&](bool heights) {
        return BrickField::generate(base.box(), ctx, [&](const IndexBox& brick, float* samples) {
            float constant = 0;
            if (base.constantIn(brick, constant) && std::abs(constant) >= kLayer) {
                std::fill_n(samples, BrickField::kSamples, 0.f);
                return;
            }
            forEachVoxel(brick, [&](const Index3& p) {
                const std::int32_t i = layer.voxels.find(p);
                const bool known = i >= 0 && isMeant(base, layer, std::size_t(i));
                *samples++ = !known ? 0.f : heights ? layer.point[std::size_t(i)].height : 1.f;
            });
        });
    };
    return {fieldOf(true), fieldOf(false)};
}

// The mean at every voxel by a Gaussian of `sigma` voxels, from fields of which a sample is 2^halvings wide.
std::vector<float> meansAt(const Weighted& fields, int halvings, double sigma,
                           const std::vector<Index3>& voxels, const RunContext& ctx) {
    const double cell = double(1 << halvings), ofHalving = (cell * cell - 1) / 12;
    const double variance =
        (sigma * sigma - ofHalving) / (cell * cell) - (halvings > 0 ? kLinearVariance : 0);
    const double own = std::sqrt(std::max(0.0, variance));
    const BrickField sum = gaussianMean(fields.sum, own, ctx), weight = gaussianMean(fields.weight, own, ctx);
    std::vector<float> means(voxels.size());
    parallelFor(ctx, voxels.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto placed = [&](int v) { return float((v + 0.5) / cell - 0.5); };
            const Vec3f at{placed(voxels[i].x), placed(voxels[i].y), placed(voxels[i].z)};
            const float under = sampleTrilinear(weight, at);
            means[i] = under > 1e-6f ? sampleTrilinear(sum, at) / under : 0.f;
        }
    });
    return means;
}

double deviationOf(const std::vector<float>& fine, const std::vector<float>& coarse) {
    double sum = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const double difference = double(fine[i]) - double(coarse[i]);
        sum += difference * difference;
    }
    return std::sqrt(sum / double(std::max<std::size_t>(1, fine.size())));
}

}  // namespace

std::vector<ReliefOctave> reliefOctaves(const BaseSurface& base, const IndexBox& box,
                                        const ReliefLayer* known, const RunContext& ctx) {
    const ReliefLayer own = known ? ReliefLayer{} : reliefLayer(base, kLayer, ctx);
    const ReliefLayer& layer = known ? *known : own;
    Weighted fields = weightedHeights(layer, base.distance, ctx);
    std::vector<Index3> voxels;
    std::vector<float> finer;
    for (std::size_t i = 0; i < layer.point.size(); ++i)
        if (box.contains(layer.voxels[i]) && isMeant(base.distance, layer, i)) {
            voxels.push_back(layer.voxels[i]);
            finer.push_back(layer.point[i].height);
        }
    std::vector<ReliefOctave> octaves;
    double shortest = 0;
    int halvings = 0;
    for (double wave = kFirstWave; wave < 4 * kCutOff * base.radius; wave *= 2) {
        const double sigma = wave / kCutOff;
        // Two samples a standard deviation, at least.
        while (sigma / double(2 << halvings) > 1.4) {
            fields = {halved(fields.sum, ctx), halved(fields.weight, ctx)};
            ++halvings;
        }
        std::vector<float> coarser = meansAt(fields, halvings, sigma, voxels, ctx);
        octaves.push_back({shortest, wave, deviationOf(finer, coarser)});
        finer = std::move(coarser);
        shortest = wave;
    }
    return octaves;
}

}  // namespace vdbsynth
