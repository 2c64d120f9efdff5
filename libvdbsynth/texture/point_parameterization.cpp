#include "libvdbsynth/texture/point_parameterization.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/texture/histogram_blend.h"
#include "libvdbsynth/texture/site_queue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kGapDraw = 0x7a05;
constexpr double kOnePlace = 1;  // [spacings] estimates nearer than this are one place

// One place of a patch that a gap point may take: the estimates that agree on it.
struct Place {
    std::int32_t patch = 0;
    std::vector<ChartEstimate> estimates;
    double weight = 0;
};

// Colours the points of gaps in turn, each of which then counts as one of the patch with the largest weight.
class GapFiller {
public:
    GapFiller(const PointSurface& surface, PointPatches& patches, const SampleImage& sample, double scale,
              const HistogramBlend* blend, TexturedSites& out, const RunContext& ctx)
        : mSurface(surface),
          mSites(surface.sites),
          mPatches(patches),
          mSample(sample),
          mScale(scale),
          mBlend(blend),
          mOut(out),
          mContext(ctx),
          mQueue(surface.sites.size()),
          mStage(ctx, "gaps", std::max<std::size_t>(1, patches.gaps)),
          mRead(std::size_t(sample.channels)) {}

    void fill() {
        const std::uint32_t n = std::uint32_t(mSites.size());
        for (std::uint32_t i = 0; i < n; ++i)
            if (mPatches.patch[i] >= 0) raiseAround(i);
        for (std::uint32_t next = 0; next < n;) {
            const std::uint32_t queued = mQueue.popMost().site;
            if (queued != SiteQueue::kNone) {
                colour(queued);
            } else if (mPatches.patch[next] < 0) {
                colour(next);  // reached by none
            } else {
                ++next;
            }
        }
    }

private:
    void raiseAround(std::uint32_t site) {
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
            if (mPatches.patch[mSites.neighbours[k]] < 0) mQueue.raise(mSites.neighbours[k]);
    }

    void colour(std::uint32_t site) {
        gather(site);
        if (mUsed == 0) {
            takeAny(site);
        } else {
            std::stable_sort(mPlaces.begin(), mPlaces.begin() + std::ptrdiff_t(mUsed),
                             [](const Place& a, const Place& b) { return a.weight > b.weight; });
            mUsed = std::min(mUsed, kMostBlendParts);
            take(site);
        }
        raiseAround(site);
        mStage.advance();
    }

    // What the coloured neighbours continue to, nearest first.
    void gather(std::uint32_t site) {
        mUsed = 0;
        const Vec3d at = cast<double>(mSites.point[site]);
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k) {
            const std::uint32_t other = mSites.neighbours[k];
            ChartEstimate estimate;
            const Vec3d v = (at - cast<double>(mSites.point[other])) * (1 / mSurface.spacing);
            if (mPatches.patch[other] < 0 || !continueChart(mPatches.chart[other], v, estimate)) continue;
            Place& place = placeOf(mPatches.patch[other], estimate.site.q);
            place.estimates.push_back(estimate);
            place.weight += estimate.weight;
        }
    }

    Place& placeOf(std::int32_t patch, const ChartPosition& q) {
        for (std::size_t i = 0; i < mUsed; ++i) {
            const ChartPosition& other = mPlaces[i].estimates[0].site.q;
            const double x = q.x - other.x, y = q.y - other.y;
            if (mPlaces[i].patch == patch && x * x + y * y <= kOnePlace * kOnePlace) return mPlaces[i];
        }
        if (mUsed == mPlaces.size()) mPlaces.emplace_back();
        Place& place = mPlaces[mUsed++];
        place.patch = patch;
        place.estimates.clear();
        place.weight = 0;
        return place;
    }

    void take(std::uint32_t site) {
        std::array<BlendPart, kMostBlendParts> parts;
        float sum = 0;
        for (std::size_t i = 0; i < mUsed; ++i) {
            const ChartSite mean =
                meanSite(mPlaces[i].estimates.data(), mPlaces[i].estimates.size(), siteNormal(mSites, site));
            if (i == 0) mPatches.chart[site] = mean;
            parts[i] = {mPatches.coordinate(mPlaces[i].patch, mean.q, mScale), float(mPlaces[i].weight)};
            sum += parts[i].weight;
        }
        mPatches.patch[site] = mPlaces[0].patch;
        for (std::size_t i = 0; i < mUsed; ++i) parts[i].weight /= sum;
        setPlace(site, parts[0].at);
        mOut.blended[site] = mUsed > 1;
        float* out = mOut.values.data() + std::size_t(site) * mRead.size();
        if (mUsed == 1) {
            readCubic(mSample, parts[0].at, out);
        } else if (mBlend) {
            mBlend->mix(parts.data(), mUsed, out);
        } else {
            for (std::size_t i = 0; i < mUsed; ++i) {
                readCubic(mSample, parts[i].at, mRead.data());
                for (std::size_t c = 0; c < mRead.size(); ++c) out[c] += parts[i].weight * mRead[c];
            }
        }
    }

    // Without an estimate: the place of the nearest coloured neighbour, or one drawn.
    void takeAny(std::uint32_t site) {
        std::uint32_t k = mSites.begin[site];
        while (k < mSites.begin[site + 1] && mPatches.patch[mSites.neighbours[k]] < 0) ++k;
        if (k < mSites.begin[site + 1]) {
            mPatches.chart[site] = mPatches.chart[mSites.neighbours[k]];
            mPatches.patch[site] = mPatches.patch[mSites.neighbours[k]];
        } else {
            Random random(mContext.seed, mSurface.order[site], kGapDraw);
            mPatches.chart[site] = seedChart(mSites, site, siteTangent(mSurface, site, {}, mContext.seed));
            mPatches.patch[site] = std::int32_t(mPatches.origin.size());
            mPatches.origin.push_back({float(random.uniform(0, double(mSample.width))),
                                       float(random.uniform(0, double(mSample.height)))});
        }
        setPlace(site, mPatches.coordinate(mPatches.patch[site], mPatches.chart[site].q, mScale));
        readCubic(mSample, mOut.coordinate[site], mOut.values.data() + std::size_t(site) * mRead.size());
    }

    void setPlace(std::uint32_t site, const Vec2f& at) {
        mOut.sample[site] = 0;
        mOut.coordinate[site] = at;
        mOut.tangent[site] = surfaceTangent(mSurface, site, mPatches.chart[site].s);
    }

    const PointSurface& mSurface;
    const SurfaceSites& mSites;
    PointPatches& mPatches;
    const SampleImage& mSample;
    double mScale;
    const HistogramBlend* mBlend;
    TexturedSites& mOut;
    const RunContext& mContext;
    SiteQueue mQueue;
    Stage mStage;
    std::vector<float> mRead;
    std::vector<Place> mPlaces;
    std::size_t mUsed = 0;
};

void requireAtLeast0(double value, const char* field) {
    requireOption(std::isfinite(value) && value >= 0, field, exactText(value), "a number of at least 0");
}

bool mixesByHistogram(SampleBlend blend, const SampleImage& sample, const RunContext& ctx) {
    if (blend != SampleBlend::Automatic) return blend == SampleBlend::Histogram;
    const double loss = blendLoss(sample, ctx);
    const bool suits = loss <= kBlendSuits;
    message(ctx, MessageLevel::Detail,
            "mixed windows of the sample are " + roundedText(loss, 3) +
                " times as far from its own as those are from each other (at most " + exactText(kBlendSuits) +
                " for mixing by histogram): gaps are mixed " + (suits ? "by histogram" : "by weight"));
    return suits;
}

}  // namespace

void validate(const PointParameterizationOptions& options) {
    requireOption(options.neighbours >= 3 && options.neighbours <= 256, "neighbours",
                  std::to_string(options.neighbours), "a whole number from 3 to 256");
    requireOption(std::isfinite(options.scale) && options.scale > 0, "scale", exactText(options.scale),
                  "a number above 0");
    requireOption(options.patchSize > 0 && options.patchSize <= 1, "patchSize", exactText(options.patchSize),
                  "above 0 and at most 1");
    requireOption(options.blend != SampleBlend::Off, "blend", "off",
                  "automatic, by weight or by histogram: gaps have to be mixed");
    requireAtLeast0(options.distortion.w1, "w1");
    requireAtLeast0(options.distortion.w2, "w2");
    requireAtLeast0(options.distortion.w3, "w3");
    requireAtLeast0(options.distortion.w4, "w4");
    requireAtLeast0(options.distortion.threshold, "threshold");
    validate(options.orientation);
}

PointParameterizationResult parameterizePoints(const TextureTarget& target, const SampleImage& sample,
                                               const PointParameterizationOptions& options,
                                               const RunContext& ctx) {
    validate(options);
    requireSample(sample);
    return withThreads(ctx, [&] {
        const PointSurface surface = pointSurface(target, options.neighbours, ctx);
        PointPatches patches = growPatches(surface, sample, options, ctx);
        PointParameterizationResult result;
        result.spacing = surface.spacing;
        result.texel = surface.spacing * options.scale;
        result.patches = patches.origin.size();
        result.gaps = patches.gaps;
        result.patch.resize(surface.order.size());
        result.position.resize(surface.order.size());
        for (std::size_t i = 0; i < surface.order.size(); ++i) {
            result.patch[surface.order[i]] = patches.patch[i];
            result.position[surface.order[i]] = patches.chart[i].q;
        }
        TexturedSites sites = uncoloured(surface.order.size(), sample.channels);
        colourPatches(surface, patches, sample, options.scale, sites, ctx);
        std::optional<HistogramBlend> blend;
        if (result.gaps > 0 && mixesByHistogram(options.blend, sample, ctx)) blend.emplace(sample, ctx);
        result.histogram = blend.has_value();
        if (result.gaps > 0)
            GapFiller(surface, patches, sample, options.scale, blend ? &*blend : nullptr, sites, ctx).fill();
        result.sites = inTargetOrder(sites, surface.order);
        return result;
    });
}

}  // namespace vdbsynth
