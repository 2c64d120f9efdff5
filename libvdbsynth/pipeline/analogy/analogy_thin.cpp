// How much of a texture's depth the thin parts of a target bear.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/distance_transform.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/measure/thickness.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

constexpr float kCore = 1.5f;        // [voxels] radius that has to stay under the texture
constexpr float kBeyond = 2;         // [voxels] past the texture's depth and reach, where weights matter
constexpr int kSmooth = 3;           // [samples] weights are smoothed over cubes of 2 of it + 1
constexpr double kFinest = 1 << 25;  // samples; larger boxes are measured on every second voxel, and so on
constexpr double kWorthSaying = 0.0005;  // share of the surface

// The share of a depth that a part of a radius bears.
float shareOf(float radius, float dig, ThinParts thin) {
    const float left = radius - kCore;
    if (thin == ThinParts::Scale) return std::clamp(left / dig, 0.f, 1.f);
    // All of it where as much again stays below, none where nothing would.
    const float u = std::clamp((left - dig) / dig, 0.f, 1.f);
    return u * u * (3 - 2 * u);
}

// Weights of the samples of a solid next to its surface, -1 elsewhere.
class ThinSamples {
public:
    ThinSamples(const BrickField& plain, float dig, float band, const AnalogyOptions& options,
                const RunContext& ctx)
        : mCoarsening(options.draft ? 2 : 1) {
        while (double(plain.box().volume()) > kFinest * mCoarsening * mCoarsening * mCoarsening)
            mCoarsening *= 2;
        const Distances distances = distancesToSurface(plain, band, mCoarsening, ctx);
        mSize = distances.size;
        const Thickness thickness = localThickness(distances, mCoarsening, Phase::Solid, ctx);
        const float deepest = dig + kBeyond + float(kSmooth * mCoarsening);
        std::vector<float> raw(distances.values.size(), -1.f);
        parallelFor(ctx, raw.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const float depth = -distances.values[i] * float(mCoarsening);
                if (depth > 0 && depth <= deepest)
                    raw[i] = shareOf(thickness.diameter[i] / 2, dig, options.thin);
            }
        });
        mWeight = smoothed(raw, ctx);
    }

    // At a position in the solid [voxels]; 0 where the solid is thinner than a sample.
    float at(const Vec3f& p) const {
        const float c = float(mCoarsening);
        const auto sample = [&](float v) { return int(std::lround((v - (c - 1) / 2) / c)); };
        const Index3 middle{sample(p.x), sample(p.y), sample(p.z)};
        float nearest = 1e9f, weight = 0;
        forEachVoxel(IndexBox{middle, middle}.expanded(1).intersection(IndexBox::fromSize(mSize)),
                     [&](const Index3& s) {
                         const float value = mWeight[latticeIndex(s, mSize)];
                         const Vec3f offset = Vec3f{float(s.x), float(s.y), float(s.z)} * c +
                                              Vec3f{1, 1, 1} * ((c - 1) / 2) - p;
                         if (value < 0 || dot(offset, offset) >= nearest) return;
                         nearest = dot(offset, offset);
                         weight = value;
                     });
        return weight;
    }

private:
    // Lower where a neighbourhood's mean is, so that a thin part's depth changes before it begins.
    std::vector<float> smoothed(const std::vector<float>& raw, const RunContext& ctx) const {
        std::vector<float> result = raw;
        const IndexBox box = IndexBox::fromSize(mSize);
        parallelFor(ctx, std::size_t(mSize.x), 1, [&](std::size_t begin, std::size_t end) {
            const IndexBox slabs{{int(begin), 0, 0}, {int(end) - 1, mSize.y - 1, mSize.z - 1}};
            forEachVoxel(slabs, [&](const Index3& p) {
                float& value = result[latticeIndex(p, mSize)];
                if (value < 0) return;
                float sum = 0, count = 0;
                forEachVoxel(IndexBox{p, p}.expanded(kSmooth).intersection(box), [&](const Index3& q) {
                    const float other = raw[latticeIndex(q, mSize)];
                    if (other < 0) return;
                    sum += other;
                    ++count;
                });
                value = std::min(value, sum / count);
            });
        });
        return result;
    }

    int mCoarsening;
    Index3 mSize;
    std::vector<float> mWeight;
};

// Share of the surface's voxels where a weight is under 1.
double thinShare(const BrickField& plain, const BrickField& weight, const RunContext& ctx) {
    const VoxelTable surface = VoxelTable::where(
        plain, [](float d) { return d > -1 && d <= 0; }, ctx);
    std::size_t thin = 0;
    for (const Index3& p : surface.voxels()) thin += weight.inside(p) < 1;
    return double(thin) / double(std::max<std::size_t>(surface.size(), 1));
}

}  // namespace

float digOf(const BrickField& plain, const BrickField& textured) {
    float dig = 0, deepest = 0;
    const Index3 size = plain.box().size();
    std::vector<float> a(std::size_t(size.y) * std::size_t(size.z)), b(a.size());
    for (int x = 0; x < size.x; ++x) {
        plain.readBox({x, 0, 0}, {1, size.y, size.z}, a.data());
        textured.readBox({x, 0, 0}, {1, size.y, size.z}, b.data());
        for (std::size_t i = 0; i < a.size(); ++i) {
            deepest = std::max(deepest, -a[i]);
            if (b[i] >= 0) dig = std::max(dig, -a[i]);
        }
    }
    return dig > deepest - kBeyond ? -1 : dig;
}

BrickField thinWeight(const BrickField& plain, float dig, float reach, float band,
                      const AnalogyOptions& options, const RunContext& ctx) {
    const ThinParts thin = options.thin;
    if (thin == ThinParts::AsIs || dig < 1) return {};
    requireMemory(ctx, std::min(double(plain.box().volume()), kFinest) * 24, "the thickness of the target",
                  "use larger voxels or set `thin` to as-is");
    Stage stage(ctx, "thickness of the target", 2);
    const ThinSamples samples(plain, dig, band, options, ctx);
    BrickField weight = BrickField::fromVoxels(plain.box(), ctx, [&](const Index3& p) {
        const float d = plain.inside(p);
        if (d > reach + kBeyond || d < -dig - kBeyond) return 1.f;
        Vec3f at{float(p.x), float(p.y), float(p.z)};
        if (d > -0.5f) at = at - sampleGradient(plain, at) * (d + 0.5f);
        return samples.at(at);
    });
    stage.advance(2);
    const double share = thinShare(plain, weight, ctx);
    if (share < kWorthSaying) return {};
    message(ctx, MessageLevel::Note,
            "the texture is " + roundedText(dig, 2) + " voxels deep; on " + roundedText(100 * share, 2) +
                " % of the surface the target is too thin for that and the texture is " +
                (thin == ThinParts::Scale ? "shallower" : "left out") +
                " (`thin`; as-is cuts through, larger `resolution` leaves more of it)");
    return weight;
}

}  // namespace vdbsynth
