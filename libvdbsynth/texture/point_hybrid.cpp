#include "libvdbsynth/texture/point_hybrid.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/texture/site_queue.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Points of patches near gaps join them, `steps` times. @return number of points in gaps
std::size_t widenGaps(const SurfaceSites& sites, std::vector<std::int32_t>& patch, int steps,
                      const RunContext& ctx) {
    for (int step = 0; step < steps; ++step) {
        const std::vector<std::int32_t> before = patch;
        parallelFor(ctx, sites.size(), 8192, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
                    if (before[sites.neighbours[k]] == PointPatches::kGap) patch[i] = PointPatches::kGap;
        });
    }
    return std::size_t(std::count(patch.begin(), patch.end(), PointPatches::kGap));
}

// Directions of points in gaps from those around that have one: the mean by 1 / distance, the point with the
// most of them first.
void continueTangents(const PointSurface& surface, const PointOrientationOptions& options,
                      const std::vector<std::int32_t>& patch, std::vector<Vec3f>& tangent,
                      const RunContext& ctx) {
    const SurfaceSites& sites = surface.sites;
    std::vector<char> has(sites.size());
    SiteQueue queue(sites.size());
    const auto finish = [&](std::uint32_t site) {
        has[site] = 1;
        for (std::uint32_t k = sites.begin[site]; k < sites.begin[site + 1]; ++k) {
            const std::uint32_t other = sites.neighbours[k];
            if (!has[other] && patch[other] == PointPatches::kGap) queue.raise(other);
        }
    };
    const auto set = [&](std::uint32_t site) {
        Vec3f sum;
        for (std::uint32_t k = sites.begin[site]; k < sites.begin[site + 1]; ++k) {
            const std::uint32_t other = sites.neighbours[k];
            if (has[other]) sum = sum + tangent[other] * (1 / length(sites.point[other] - sites.point[site]));
        }
        const bool given =
            !surface.direction.empty() && dot(surface.direction[site], surface.direction[site]) > 0;
        tangent[site] = given || !(dot(sum, sum) > 0) ? siteTangent(surface, site, options, ctx.seed)
                                                      : tangentNear(sites.normal[site], sum);
        finish(site);
    };
    for (std::uint32_t i = 0; i < sites.size(); ++i)
        if (patch[i] != PointPatches::kGap) finish(i);
    for (std::uint32_t next = 0; next < sites.size();) {
        const std::uint32_t queued = queue.popMost().site;
        if (queued != SiteQueue::kNone)
            set(queued);
        else if (!has[next])
            set(next);
        else
            ++next;
    }
}

SampleImage cropped(const SampleImage& sample, const SampleWindow& window) {
    if (window.width == sample.width && window.height == sample.height) return sample;
    SampleImage out{window.width, window.height, sample.channels, false, {}};
    out.values.reserve(out.texels() * std::size_t(out.channels));
    for (int y = 0; y < window.height; ++y) {
        const float* row = sample.texel(window.x, window.y + y);
        out.values.insert(out.values.end(), row, row + std::ptrdiff_t(window.width) * sample.channels);
    }
    return out;
}

class Hybrid {
public:
    Hybrid(const TextureTarget& target, const SampleImage& sample, const PointHybridOptions& options,
           const RunContext& ctx)
        : mSample(sample),
          mOptions(options),
          mContext(ctx),
          mSurface(pointSurface(target, options.parameterization.neighbours, ctx)) {}

    PointHybridResult run() {
        cut();
        match();
        mResult.sites = inTargetOrder(mSites, mSurface.order);
        return std::move(mResult);
    }

private:
    // Patches, with gaps as wide as features.
    void cut() {
        const PointParameterizationOptions& options = mOptions.parameterization;
        PointPatches patches = growPatches(mSurface, mSample, options, mContext);
        mResult.texel = mSurface.spacing * options.scale;
        mResult.featureSize = mOptions.featureSize > 0 ? mOptions.featureSize : featureSize(mSample);
        mResult.patches = patches.origin.size();
        mResult.gaps = patches.gaps;
        const double step = std::sqrt(double(options.neighbours));
        const double missing = mResult.featureSize * options.scale - step / 2;
        const int steps = patches.gaps > 0 ? int(std::clamp(std::round(missing / step), 0.0, 1000.0)) : 0;
        mResult.widened = widenGaps(mSurface.sites, patches.patch, steps, mContext);
        mSites = uncoloured(mSurface.order.size(), mSample.channels);
        colourPatches(mSurface, patches, mSample, options.scale, mSites, mContext);
        continueTangents(mSurface, options.orientation, patches.patch, mSites.tangent, mContext);
        mPatch = std::move(patches.patch);
    }

    void match() {
        const std::size_t n = mSurface.order.size();
        const SampleWindow window =
            typicalWindow(mSample, mOptions.matchSample > 0 ? mOptions.matchSample
                                                            : std::max(mSample.width, mSample.height));
        const Vec2f corner{float(window.x), float(window.y)};
        std::vector<MatchLevel> levels(1);
        MatchLevel& level = levels[0];
        level.sites = mSurface.sites;
        level.tangent = mSites.tangent;
        level.texel = mResult.texel;
        level.coloured.resize(n);
        level.coordinate.resize(n);
        level.values = mSites.values;
        for (std::size_t i = 0; i < n; ++i) {
            level.coloured[i] = mPatch[i] != PointPatches::kGap;
            level.coordinate[i] = mSites.coordinate[i] - corner;
        }
        PointMatchingOptions options;
        options.neighbours = mOptions.parameterization.neighbours;
        options.scale = mOptions.parameterization.scale;
        options.levels = mOptions.levels;
        options.coherent = mOptions.coherent;
        const double compared = mResult.widened > 0 ? matchLevels(levels, cropped(mSample, window),
                                                                  options.levels, options, mContext)
                                                    : 0;
        mResult.tried = compared / double(std::max<std::size_t>(1, mResult.widened));
        mResult.matched.assign(n, 0);
        mSites.sample.assign(n, 0);
        mSites.values = std::move(levels[0].values);
        for (std::size_t i = 0; i < n; ++i) {
            if (mPatch[i] != PointPatches::kGap) continue;
            mResult.matched[mSurface.order[i]] = 1;
            mSites.coordinate[i] = levels[0].coordinate[i] + corner;
        }
    }

    const SampleImage& mSample;
    const PointHybridOptions& mOptions;
    const RunContext& mContext;
    PointSurface mSurface;
    std::vector<std::int32_t> mPatch;
    TexturedSites mSites;
    PointHybridResult mResult;
};

}  // namespace

void validate(const PointHybridOptions& options) {
    validate(options.parameterization);
    requireOption(options.levels >= 1 && options.levels <= 8, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 8");
    requireOption(std::isfinite(options.featureSize) && options.featureSize >= 0, "featureSize",
                  exactText(options.featureSize), "a number of at least 0");
    requireOption(options.matchSample == 0 || options.matchSample >= 8, "matchSample",
                  std::to_string(options.matchSample), "0 or a whole number of at least 8");
}

PointHybridResult texturePointsHybrid(const TextureTarget& target, const SampleImage& sample,
                                      const PointHybridOptions& options, const RunContext& ctx) {
    validate(options);
    requireSample(sample);
    return withThreads(ctx, [&] { return Hybrid(target, sample, options, ctx).run(); });
}

}  // namespace vdbsynth
