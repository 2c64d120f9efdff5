// Means of distances on a coarser lattice, and back.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/base_surface_steps.h"
#include "libvdbsynth/relief/gaussian_mean.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

// A wave of a step's length would read as none at all without a mean over the step.
constexpr double kStepsOfMean = 0.5;
constexpr float kReachOfMeans = 2.5f;  // steps
constexpr int kLargestStep = 4;        // keeps the band in which those means are taken narrow
constexpr double kRadiusOfStep = 2.5;  // samples within a radius, for cubic polynomials

// The four weights of Catmull-Rom's polynomial at a fraction of a step.
std::array<float, 4> cubicWeights(float t) {
    return {((2 - t) * t - 1) * t / 2, ((3 * t - 5) * t * t + 2) / 2, ((4 - 3 * t) * t + 1) * t / 2,
            (t - 1) * t * t / 2};
}

// Interpolates the last axis of [rows x length] to kSide samples and moves it to the front.
void refineLast(const std::vector<float>& in, int rows, int length, int first, int step, int corner,
                std::vector<float>& out) {
    out.resize(std::size_t(rows) * BrickField::kSide);
    for (int i = 0; i < BrickField::kSide; ++i) {
        const int at = corner + i, low = (at >= 0 ? at : at - step + 1) / step;
        const std::array<float, 4> w = cubicWeights(float(at - low * step) / float(step));
        const int from = low - 1 - first;
        for (int row = 0; row < rows; ++row) {
            const float* v = in.data() + std::size_t(row) * std::size_t(length) + from;
            out[std::size_t(i) * std::size_t(rows) + std::size_t(row)] =
                w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3];
        }
    }
}

}  // namespace

int smoothingStep(double radius) {
    return std::clamp(int(radius / kRadiusOfStep), 1, kLargestStep);
}

float wideReach(int step, float reach) {
    return step <= kFarStep ? reach : kReachOfMeans * float(step) + 1;
}

SmoothField latticeDistances(const WideDistances& scan, int step, float reach, const RunContext& ctx,
                             bool means) {
    if (step == 1) return {joined(scan, reach, ctx), 1};
    const float side = float(step), known = kReachOfMeans * side + 1;
    const BrickField wide = joined(scan, known, ctx);
    BrickField exact =
        step == kFarStep ? scan.far.field : widenedDistances(wide, known, step, reach, ctx).field;
    if (!means) return {std::move(exact), step};
    // Far from the surface the distances bend so little that a mean of three samples is the same.
    const BrickField far = gaussianMean(exact, kStepsOfMean, ctx);
    const BrickField fine = gaussianMean(wide, kStepsOfMean * double(step), ctx);
    BrickField both = BrickField::generate(exact.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float own[BrickField::kSamples];
        exact.readBox(brick.min, brick.size(), own);
        far.readBox(brick.min, brick.size(), samples);
        const float* distance = own;
        forEachVoxel(brick, [&](const Index3& p) {
            const float weight = std::clamp((1.5f * side - std::abs(*distance++)) / (0.5f * side), 0.f, 1.f);
            if (weight > 0) *samples += weight * (fine.at(p * step) - *samples);
            ++samples;
        });
    });
    return {std::move(both), step};
}

SmoothField coarserMeans(const SmoothField& means, const RunContext& ctx) {
    // Variances add up: of a mean over twice the samples three quarters are missing.
    const BrickField wider = gaussianMean(means.field, std::sqrt(3.0) * kStepsOfMean, ctx);
    const BrickField every = BrickField::fromVoxels(latticeBox(means.field.box(), 2), ctx,
                                                    [&](const Index3& p) { return wider.at(p * 2); });
    return {every, 2 * means.step};
}

SmoothField smoothedDistances(const SmoothField& distances, BaseKind kind, double radius,
                              const RunContext& ctx) {
    const double step = distances.step, own = distances.step > 1 ? kStepsOfMean : 0, full = radius / step;
    BrickField once = gaussianMean(distances.field, std::sqrt(full * full - own * own), ctx);
    if (kind == BaseKind::Gaussian) return {std::move(once), distances.step};
    const BrickField twice = gaussianMean(once, full, ctx);
    BrickField base = BrickField::generate(once.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float second[BrickField::kSamples];
        once.readBox(brick.min, brick.size(), samples);
        twice.readBox(brick.min, brick.size(), second);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = 2 * samples[i] - second[i];
    });
    return {std::move(base), distances.step};
}

BrickField refined(const SmoothField& smooth, const IndexBox& box, float limit, const RunContext& ctx) {
    const int step = smooth.step, length = BrickField::kSide / step + 5;
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        if (step == 1) {
            smooth.field.readBox(brick.min, brick.size(), samples);
        } else {
            const Index3 first{brick.min.x / step - 1, brick.min.y / step - 1, brick.min.z / step - 1};
            std::vector<float> a(std::size_t(length) * std::size_t(length) * std::size_t(length)), b;
            smooth.field.readBox(first, {length, length, length}, a.data());
            const auto [low, high] = std::minmax_element(a.begin(), a.end());
            if (*low > limit || *high < -limit) {
                std::fill_n(samples, BrickField::kSamples, *low > 0 ? limit : -limit);
                return;
            }
            refineLast(a, length * length, length, first.z, step, brick.min.z, b);
            refineLast(b, BrickField::kSide * length, length, first.y, step, brick.min.y, a);
            refineLast(a, BrickField::kSide * BrickField::kSide, length, first.x, step, brick.min.x, b);
            std::copy_n(b.data(), BrickField::kSamples, samples);
        }
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = std::clamp(samples[i], -limit, limit);
    });
}

std::vector<float> distancesFromBase(const SmoothField& smooth, const Mesh& surface, const RunContext& ctx) {
    std::vector<float> distances(surface.points.size());
    const float step = float(smooth.step);
    parallelFor(ctx, distances.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f at = surface.points[i] * (1 / step);
            const float slope = length(sampleGradient(smooth.field, at)) / step;
            distances[i] = std::abs(sampleTrilinear(smooth.field, at)) / std::max(slope, 0.5f);
        }
    });
    return distances;
}

}  // namespace vdbsynth
