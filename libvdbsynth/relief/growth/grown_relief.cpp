#include "libvdbsynth/relief/growth/grown_relief.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/relief/growth/grown_relief_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kDrawsMatch = 0x72736432;  // purpose of the random numbers
constexpr double kFlat = 0.01;                     // [voxels] displacements under it are no relief
constexpr double kMuchCapped = 0.05;               // share of distances at the band's half-width
constexpr std::size_t kSitesAPart = 20;            // fewer: the neighbourhood is too small to grow
constexpr std::size_t kNearest = 16;               // sites asked for the nearest that faces the same way

std::string printed(double value) {
    return roundedText(value, 4);
}

// Growth with its state; one for a call.
class Growth {
public:
    Growth(const ReliefSites& sample, const ReliefDistance& distance, const SurfaceSites& target,
           const std::vector<Vec3f>& tangent, double radius, const GrownReliefOptions& options,
           const RunContext& ctx)
        : mSample(sample),
          mTarget(target),
          mOptions(options),
          mContext(ctx),
          mNeighbourhoods(reliefNeighbourhoods(target, radius, options.weightFalloff, ctx)),
          mSampleFrames(reliefFrames(sample.sites, sample.tangent, ctx)),
          mTargetFrames(reliefFrames(target, tangent, ctx)),
          mMatcher(mSampleFrames, distance),
          mSampleTree(sample.sites.point),
          mQueue(mNeighbourhoods, target.size()),
          mSeedRadius(options.seedRadius > 0 ? options.seedRadius : radius) {
        mResult.neighbourhood = radius;
        mResult.source.resize(target.size());
        mResult.order.resize(target.size());
        mResult.displacement.resize(target.size());
    }

    GrownRelief run() {
        const std::uint32_t seed = seedOfSample(mSample, mSeedRadius, mOptions.seedSite, mContext);
        const std::vector<float> flat = flatness(mTarget, mNeighbourhoods);
        const ReliefNeighbourhoods patches = mSeedRadius == mResult.neighbourhood
                                                 ? mNeighbourhoods
                                                 : reliefNeighbourhoods(mTarget, mSeedRadius, 1, mContext);
        std::vector<std::uint32_t> starts(mTarget.size());
        for (std::size_t i = 0; i < starts.size(); ++i) starts[i] = std::uint32_t(i);
        std::stable_sort(starts.begin(), starts.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return flat[a] > flat[b]; });
        if (mOptions.targetSite >= 0) starts.insert(starts.begin(), std::uint32_t(mOptions.targetSite));
        Stage stage(mContext, "growing relief", mTarget.size());
        for (std::uint32_t start : starts) {
            if (mQueue.isDone(start)) continue;
            copySeed(seed, start, patches, stage);
            for (std::uint32_t t; mQueue.next(t);) {
                grow(t);
                stage.advance();
            }
        }
        const double voxel = mMatcher.distance().voxel();
        if (mMatched > 0) mResult.grownMean = mCosts / double(mMatched) * voxel * voxel;
        return std::move(mResult);
    }

    const ReliefNeighbourhoods& neighbourhoods() const { return mNeighbourhoods; }
    const std::vector<ReliefFrame>& sampleFrames() const { return mSampleFrames; }

private:
    void take(std::uint32_t t, std::uint32_t source) {
        mResult.source[t] = source;
        mResult.displacement[t] =
            mapped(mSample.displacement[source], mSampleFrames[source], mTargetFrames[t]);
        mResult.order[t] = mGrown++;
        mQueue.done(t);
    }

    // Step 1. Sites that are done already keep what they have.
    void copySeed(std::uint32_t seed, std::uint32_t start, const ReliefNeighbourhoods& patches,
                  Stage& stage) {
        ++mResult.seeds;
        take(start, seed);
        stage.advance();
        const ReliefFrame &from = mTargetFrames[start], &to = mSampleFrames[seed];
        for (std::size_t k = patches.begin[start]; k < patches.begin[start + 1]; ++k) {
            const std::uint32_t v = patches.member[k];
            if (mQueue.isDone(v)) continue;
            const Vec3f place = to.point + mapped(mTarget.point[v] - from.point, from, to);
            take(v, nearestSource(place, mapped(mTarget.normal[v], from, to)));
            stage.advance();
        }
    }

    // The nearest site of the sample that faces the same way; the nearest where none of a few does.
    std::uint32_t nearestSource(const Vec3f& place, const Vec3f& normal) const {
        std::uint32_t numbers[kNearest];
        float squared[kNearest];
        const std::size_t got = mSampleTree.nearest(place, kNearest, numbers, squared);
        for (std::size_t k = 0; k < got; ++k)
            if (dot(mSample.sites.normal[numbers[k]], normal) > 0) return numbers[k];
        return numbers[0];
    }

    // Steps 3 and 4.
    void grow(std::uint32_t t) {
        mMatcher.terms(mTargetFrames[t], mTarget, mResult.displacement, mNeighbourhoods, t, mQueue.allDone(),
                       mTerms);
        const std::size_t sites = mSampleFrames.size();
        const std::size_t count =
            std::clamp<std::size_t>(std::size_t(std::lround(mOptions.top / 100 * double(sites))), 1, sites);
        const std::vector<ReliefMatch> best = mMatcher.best(mTerms, count, likely(t), mContext);
        const ReliefMatch& match =
            best[Random(mContext.seed, t, kDrawsMatch).below(std::uint32_t(best.size()))];
        float weights = 0;
        for (const ReliefTerm& term : mTerms) weights += term.weight;
        if (weights > 0) mCosts += double(match.cost / weights);
        ++mMatched;
        take(t, match.site);
    }

    // Where neighbours came from, and the sites around there: good matches are often among them.
    std::vector<std::uint32_t> likely(std::uint32_t t) const {
        std::vector<std::uint32_t> sites;
        std::size_t asked = 0;
        for (std::size_t k = mNeighbourhoods.begin[t]; k < mNeighbourhoods.begin[t + 1] && asked < 6; ++k) {
            const std::uint32_t v = mNeighbourhoods.member[k];
            if (!mQueue.isDone(v)) continue;
            ++asked;
            const std::uint32_t source = mResult.source[v];
            const SurfaceSites& sample = mSample.sites;
            sites.push_back(source);
            sites.insert(sites.end(), sample.neighbours.begin() + std::ptrdiff_t(sample.begin[source]),
                         sample.neighbours.begin() + std::ptrdiff_t(sample.begin[source + 1]));
        }
        return sites;
    }

    const ReliefSites& mSample;
    const SurfaceSites& mTarget;
    const GrownReliefOptions& mOptions;
    const RunContext& mContext;
    ReliefNeighbourhoods mNeighbourhoods;
    std::vector<ReliefFrame> mSampleFrames, mTargetFrames;
    ReliefMatcher mMatcher;
    PointNeighbours mSampleTree;
    GrowthQueue mQueue;
    double mSeedRadius;
    std::uint32_t mGrown = 0;
    double mCosts = 0;  // [voxels^2] of what was matched
    std::size_t mMatched = 0;
    std::vector<ReliefTerm> mTerms;
    GrownRelief mResult;
};

double radiusOf(const SurfaceSites& target, const GrownReliefOptions& options, const RunContext& ctx) {
    if (options.neighbourhood > 0) return options.neighbourhood;
    const double spacing = meanSpacing(target);
    if (!(spacing > 0)) return 1;  // a single site: any radius serves
    const double radius = kSpacingsInNeighbourhood * spacing;
    message(ctx, MessageLevel::Note,
            "`neighbourhood` is not given: a radius of " + printed(radius) + ", " +
                printed(kSpacingsInNeighbourhood) +
                " spacings of the target; make it about the size of the relief's features");
    return radius;
}

void sayInput(const ReliefSites& sample, const ReliefDistance& distance, const RunContext& ctx) {
    float most = 0;
    for (const Vec3f& d : sample.displacement) most = std::max(most, dot(d, d));
    if (std::sqrt(double(most)) < kFlat * distance.voxel())
        message(
            ctx, MessageLevel::Warning,
            "the sample has no relief over " + printed(kFlat) +
                " voxel: the target stays as it is; a larger radius of the base leaves more in the relief");
}

void sayResult(const GrownRelief& grown, const ReliefNeighbourhoods& neighbourhoods,
               const ReliefDistance& distance, const RunContext& ctx) {
    const std::size_t n = grown.source.size();
    if (neighbourhoods.cut > 0)
        message(ctx, MessageLevel::Warning,
                std::to_string(neighbourhoods.cut) + " neighbourhoods have over " +
                    std::to_string(kMostNeighbours) +
                    " sites, of which the nearest are compared; make "
                    "`neighbourhood` smaller or the target's sites sparser");
    if (n > 1 && neighbourhoods.member.size() == n * (n - 1))
        message(
            ctx, MessageLevel::Note,
            "the neighbourhood (radius " + printed(grown.neighbourhood) +
                ") is larger than the target, which becomes a copy of the seed patch; make `neighbourhood` "
                "smaller for new relief");
    if (grown.seeds > 1) {
        const bool many = grown.seeds > 1 + n / kSitesAPart;
        message(ctx, many ? MessageLevel::Warning : MessageLevel::Note,
                "the target has " + std::to_string(grown.seeds) +
                    " parts that growth does not connect, each with a seed patch of its own" +
                    (many ? "; make `neighbourhood`, a radius of " + printed(grown.neighbourhood) + ", larger"
                          : ""));
    }
    if (grown.mismatch.capped > kMuchCapped)
        message(ctx, MessageLevel::Warning,
                printed(100 * grown.mismatch.capped) +
                    " % of the compared places lie outside the sample's band of " +
                    printed(double(distance.halfWidth())) +
                    " voxels; widen the band, or make `neighbourhood` smaller");
}

}  // namespace

void validate(const GrownReliefOptions& options) {
    const auto require = [](double value, double low, double high, const char* field, const char* range) {
        requireOption(value >= low && value <= high, field, printed(value), range);
    };
    require(options.neighbourhood, 0, 1e30, "neighbourhood", "a radius, or 0 for 4 spacings of the target");
    require(options.weightFalloff, 0.05, 100, "weightFalloff", "0.05 to 100");
    require(options.top, 0, 100, "top", "0 to 100 percent");
    require(options.seedRadius, 0, 1e30, "seedRadius", "a radius, or 0 for that of the neighbourhood");
    requireOption(options.seedSite >= kRandomSeed, "seedSite", std::to_string(options.seedSite),
                  "a site of the sample, -1 (the most typical) or -2 (at random)");
    requireOption(options.targetSite >= kFlattestSite, "targetSite", std::to_string(options.targetSite),
                  "a site of the target, or -1 (the flattest)");
}

GrownRelief growRelief(const ReliefSites& sample, const ReliefDistance& distance, const SurfaceSites& target,
                       const std::vector<Vec3f>& targetTangent, const GrownReliefOptions& options,
                       const RunContext& ctx) {
    validate(options);
    requireReliefSites(sample, "the sample");
    requireSites(target, targetTangent, "the target");
    requireOption(options.seedSite < std::int64_t(sample.sites.size()), "seedSite",
                  std::to_string(options.seedSite), "under the sample's number of sites");
    requireOption(options.targetSite < std::int64_t(target.size()), "targetSite",
                  std::to_string(options.targetSite), "under the target's number of sites");
    return withThreads(ctx, [&] {
        sayInput(sample, distance, ctx);
        Growth growth(sample, distance, target, targetTangent, radiusOf(target, options, ctx), options, ctx);
        GrownRelief result = growth.run();
        std::vector<ReliefFrame> source(target.size());
        for (std::size_t t = 0; t < source.size(); ++t) source[t] = growth.sampleFrames()[result.source[t]];
        result.mismatch = assignedMismatch({target, targetTangent, result.displacement}, source, distance,
                                           growth.neighbourhoods(), ctx);
        sayResult(result, growth.neighbourhoods(), distance, ctx);
        return result;
    });
}

}  // namespace vdbsynth
