#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/texture/point_parameterization.h"
#include "libvdbsynth/texture/site_queue.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kSeedDraw = 0x7a03, kWindowDraw = 0x7a04;

// The box of a patch.
struct ChartBox {
    double left = 0, right = 0, low = 0, high = 0;

    ChartBox with(const ChartPosition& q) const {
        return {std::min(left, q.x), std::max(right, q.x), std::min(low, q.y), std::max(high, q.y)};
    }
};

class Grower {
public:
    Grower(const PointSurface& surface, const SampleImage& sample,
           const PointParameterizationOptions& options, const RunContext& ctx)
        : mSurface(surface),
          mSites(surface.sites),
          mSample(sample),
          mOptions(options),
          mContext(ctx),
          mQueue(surface.sites.size()),
          mStage(ctx, "patches", std::max<std::size_t>(1, surface.sites.size())) {
        const double open = std::numeric_limits<double>::infinity();
        const double side = options.patchSize * options.scale;
        mWidest = sample.tileable ? open : side * sample.width;
        mHighest = sample.tileable ? open : side * sample.height;
        mResult.patch.assign(mSites.size(), kFree);
        mResult.chart.resize(mSites.size());
    }

    PointPatches grow() {
        RandomOrder seeds(mSites.size(), mContext.seed, kSeedDraw);
        const auto isFree = [&](std::uint32_t i) { return mResult.patch[i] == kFree; };
        for (std::uint32_t seed; (seed = seeds.next(isFree)) < mSites.size();) {
            start(seed);
            for (std::uint32_t next; (next = mQueue.popMost().site) != SiteQueue::kNone;) consider(next);
            finish();
        }
        return std::move(mResult);
    }

private:
    static constexpr std::int32_t kFree = -2;

    void start(std::uint32_t seed) {
        mNumber = std::int32_t(mResult.origin.size());
        mBox = {};
        join(seed, seedChart(mSites, seed, siteTangent(mSurface, seed, mOptions.orientation, mContext.seed)));
    }

    void join(std::uint32_t site, const ChartSite& chart) {
        mResult.patch[site] = mNumber;
        mResult.chart[site] = chart;
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
            if (mResult.patch[mSites.neighbours[k]] == kFree) mQueue.raise(mSites.neighbours[k]);
        mStage.advance();
    }

    void consider(std::uint32_t site) {
        std::size_t count = 0;
        bool any = false;
        const Vec3d at = cast<double>(mSites.point[site]);
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k) {
            const std::uint32_t other = mSites.neighbours[k];
            if (mResult.patch[other] != mNumber) continue;
            any = true;
            const Vec3d v = (at - cast<double>(mSites.point[other])) * (1 / mSurface.spacing);
            if (continueChart(mResult.chart[other], v, mEstimates[count])) ++count;
        }
        if (!any) return;
        if (count > 0) {
            const ChartSite mean = meanSite(mEstimates.data(), count, siteNormal(mSites, site));
            const ChartBox box = mBox.with(mean.q);
            if (box.right - box.left <= mWidest && box.high - box.low <= mHighest &&
                chartDistortion(mEstimates.data(), count, mean, mOptions.distortion) <=
                    mOptions.distortion.threshold) {
                mBox = box;
                join(site, mean);
                return;
            }
        }
        mResult.patch[site] = PointPatches::kGap;
        ++mResult.gaps;
        mStage.advance();
    }

    // The patch's window of the sample.
    void finish() {
        Random random(mContext.seed, std::uint64_t(mNumber), kWindowDraw);
        const double scale = mOptions.scale;
        double left = 0, low = 0, wide = mSample.width, high = mSample.height;
        if (!mSample.tileable) {
            left = -mBox.left / scale;
            low = -mBox.low / scale;
            wide -= (mBox.right - mBox.left) / scale;
            high -= (mBox.high - mBox.low) / scale;
        }
        const double x = random.uniform(), y = random.uniform();
        mResult.origin.push_back({float(left + wide * x), float(low + high * y)});
    }

    const PointSurface& mSurface;
    const SurfaceSites& mSites;
    const SampleImage& mSample;
    const PointParameterizationOptions& mOptions;
    const RunContext& mContext;
    SiteQueue mQueue;
    Stage mStage;
    PointPatches mResult;
    std::array<ChartEstimate, 256> mEstimates;
    ChartBox mBox;
    double mWidest = 0, mHighest = 0;
    std::int32_t mNumber = 0;
};

}  // namespace

PointPatches growPatches(const PointSurface& surface, const SampleImage& sample,
                         const PointParameterizationOptions& options, const RunContext& ctx) {
    return Grower(surface, sample, options, ctx).grow();
}

void colourPatches(const PointSurface& surface, const PointPatches& patches, const SampleImage& sample,
                   double scale, TexturedSites& out, const RunContext& ctx) {
    const std::size_t channels = std::size_t(sample.channels);
    parallelFor(ctx, patches.patch.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (patches.patch[i] < 0) continue;
            out.sample[i] = 0;
            out.coordinate[i] = patches.coordinate(patches.patch[i], patches.chart[i].q, scale);
            out.tangent[i] = surfaceTangent(surface, i, patches.chart[i].s);
            readCubic(sample, out.coordinate[i], out.values.data() + i * channels);
        }
    });
}

}  // namespace vdbsynth
