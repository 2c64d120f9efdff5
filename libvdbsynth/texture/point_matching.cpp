#include "libvdbsynth/texture/point_matching.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/texture/point_hierarchy.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kCoarsestDraw = 0x7a07;

void colourAtRandom(MatchLevel& level, const SampleImage& sample, std::uint64_t seed) {
    for (std::size_t i = 0; i < level.sites.size(); ++i) {
        if (level.coloured[i]) continue;
        Random random(seed, i, kCoarsestDraw);
        const int x = int(random.below(std::uint32_t(sample.width)));
        const int y = int(random.below(std::uint32_t(sample.height)));
        level.coordinate[i] = {float(x) + 0.5f, float(y) + 0.5f};
        std::copy_n(sample.texel(x, y), sample.channels,
                    level.values.begin() + std::ptrdiff_t(i * std::size_t(sample.channels)));
        level.coloured[i] = 1;
    }
}

// Means over the members of every coarser site; coloured where all are.
void mergeColours(const MatchLevel& finer, MatchLevel& coarser) {
    const std::size_t n = coarser.sites.size(),
                      channels = finer.sites.size() > 0 ? finer.values.size() / finer.sites.size() : 0;
    std::vector<std::uint32_t> members(n);
    coarser.coloured.assign(n, 1);
    coarser.coordinate.assign(n, {});
    coarser.values.assign(n * channels, 0.f);
    coarser.tangent.assign(n, {});
    for (std::size_t i = 0; i < finer.parent.size(); ++i) {
        const std::size_t p = finer.parent[i];
        if (members[p]++ == 0) coarser.coordinate[p] = finer.coordinate[i] * 0.5f;
        if (!finer.coloured[i]) coarser.coloured[p] = 0;
        coarser.tangent[p] = coarser.tangent[p] + finer.tangent[i];
        for (std::size_t c = 0; c < channels; ++c)
            coarser.values[p * channels + c] += finer.values[i * channels + c];
    }
    for (std::size_t p = 0; p < n; ++p) {
        coarser.tangent[p] = tangentNear(coarser.sites.normal[p], coarser.tangent[p]);
        for (std::size_t c = 0; c < channels; ++c) coarser.values[p * channels + c] /= float(members[p]);
    }
}

}  // namespace

void validate(const PointMatchingOptions& options) {
    requireOption(options.neighbours >= 3 && options.neighbours <= 256, "neighbours",
                  std::to_string(options.neighbours), "a whole number from 3 to 256");
    requireOption(std::isfinite(options.scale) && options.scale > 0, "scale", exactText(options.scale),
                  "a number above 0");
    requireOption(options.levels >= 1 && options.levels <= 8, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 8");
    validate(options.orientation);
}

SampleImage halved(const SampleImage& image) {
    SampleImage half{(image.width + 1) / 2, (image.height + 1) / 2, image.channels, image.tileable, {}};
    half.values.reserve(half.texels() * std::size_t(half.channels));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x) {
            const int right = std::min(2 * x + 1, image.width - 1);
            const int upper = std::min(2 * y + 1, image.height - 1);
            for (int c = 0; c < image.channels; ++c)
                half.values.push_back(0.25f * (image.texel(2 * x, 2 * y)[c] + image.texel(right, 2 * y)[c] +
                                               image.texel(2 * x, upper)[c] + image.texel(right, upper)[c]));
        }
    return half;
}

MatchLevel coarserLevel(MatchLevel& finer, int neighbours, const RunContext& ctx) {
    CoarserSites merged = mergedByFours(finer.sites, ctx);
    // Along a curve again: the order of merging wanders over the surface.
    const std::vector<std::uint32_t> order = mortonOrder(merged.point, ctx);
    std::vector<std::uint32_t> place(order.size());
    std::vector<Vec3f> points(order.size()), normals(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        place[order[i]] = std::uint32_t(i);
        points[i] = merged.point[order[i]];
        normals[i] = merged.normal[order[i]];
    }
    for (std::uint32_t& parent : merged.parent) parent = place[parent];
    finer.parent = std::move(merged.parent);
    MatchLevel coarser;
    coarser.sites = sitesOfPoints(std::move(points), std::move(normals), std::size_t(neighbours), ctx);
    coarser.texel = 2 * finer.texel;
    mergeColours(finer, coarser);
    return coarser;
}

double matchLevels(std::vector<MatchLevel>& levels, const SampleImage& sample, int count,
                   const PointMatchingOptions& options, const RunContext& ctx) {
    std::vector<SampleImage> samples{sample};
    while (int(levels.size()) < count) {
        levels.push_back(coarserLevel(levels.back(), options.neighbours, ctx));
        samples.push_back(halved(samples.back()));
    }
    if (count > 1) colourAtRandom(levels.back(), samples.back(), ctx.seed);
    double compared = 0;
    for (std::size_t l = levels.size(); l-- > 0;) {
        const bool coarsest = l + 1 == levels.size();
        if (coarsest && count > 1) continue;
        compared += matchLevel(levels[l], samples[l], coarsest ? nullptr : &levels[l + 1],
                               coarsest ? nullptr : &samples[l + 1], options, ctx);
    }
    return compared;
}

PointMatchingResult matchPoints(const TextureTarget& target, const SampleImage& sample,
                                const PointMatchingOptions& options, const RunContext& ctx) {
    validate(options);
    requireSample(sample);
    return withThreads(ctx, [&] {
        PointSurface surface = pointSurface(target, options.neighbours, ctx);
        const std::size_t n = surface.order.size();
        std::vector<MatchLevel> levels(1);
        levels[0].tangent = siteTangents(surface, options.orientation, ctx);
        levels[0].sites = std::move(surface.sites);
        levels[0].coloured.assign(n, 0);
        levels[0].coordinate.assign(n, {});
        levels[0].values.assign(n * std::size_t(sample.channels), 0.f);
        levels[0].texel = surface.spacing * options.scale;
        const double compared = matchLevels(levels, sample, options.levels, options, ctx);
        PointMatchingResult result;
        result.texel = levels[0].texel;
        for (std::size_t l = levels.size(); l-- > 0;) result.levelSites.push_back(levels[l].sites.size());
        result.tried = compared / double(n);
        TexturedSites sites = uncoloured(n, sample.channels);
        sites.sample.assign(n, 0);
        sites.coordinate = std::move(levels[0].coordinate);
        sites.tangent = std::move(levels[0].tangent);
        sites.values = std::move(levels[0].values);
        result.sites = inTargetOrder(sites, surface.order);
        return result;
    });
}

}  // namespace vdbsynth
