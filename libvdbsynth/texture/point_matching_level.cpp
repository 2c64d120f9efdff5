#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/pca.h"
#include "libvdbsynth/texture/point_matching_steps.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace vdbsynth {
namespace {

constexpr std::size_t kBatch = 16;    // sites matched at once
constexpr double kMostBytes = 256e6;  // of planes
constexpr std::uint32_t kStartDraw = 0x7a08, kTexelDraw = 0x7a09;

// The coarser sample on the finer one's texels.
SampleImage enlarged(const SampleImage& coarser, const SampleImage& finer) {
    SampleImage out = finer;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            readLinear(coarser, {(float(x) + 0.5f) * 0.5f, (float(y) + 0.5f) * 0.5f},
                       out.values.data() + (std::size_t(y) * std::size_t(out.width) + std::size_t(x)) *
                                               std::size_t(out.channels));
    return out;
}

// A coloured neighbour: its offset [eighths of texels] and colour along the axes.
struct Neighbour {
    const MatchPlanes* planes;
    int x8, y8;
    const float* values;
};

// What one site's match needs and gives; reused.
struct Slot {
    std::uint32_t site = 0;
    std::vector<Neighbour> neighbours;
    std::vector<MatchTerm> terms;
    std::vector<std::uint32_t> parents;
    std::vector<Vec2f> candidates;          // continuations of coloured neighbours
    std::vector<std::vector<float>> rooms;  // of planes that are computed as it goes
    MatchWindow window{};
    MatchBest best;
    std::size_t compared = 0;
};

class Matcher {
public:
    Matcher(MatchLevel& level, const SampleImage& sample, const MatchLevel* coarser,
            const SampleImage* coarserSample, const PointMatchingOptions& options, const RunContext& ctx)
        : mLevel(level),
          mSites(level.sites),
          mSample(sample),
          mChannels(std::size_t(sample.channels)),
          mCoarser(coarser),
          mOptions(options),
          mContext(ctx),
          mQueue(level),
          mSlots(options.coherent ? 1 : kBatch) {
        const double wide = std::ceil(2 * std::sqrt(double(options.neighbours)) / options.scale);
        const double half = std::max(1, std::min(sample.width, sample.height) / 2);
        mReach = float(std::min(wide, half));
        const int margin = int(mReach) + 2;
        const double bytes = MatchPlanes::bytes(sample, margin) * (coarser ? 2 : 1);
        const bool all = bytes <= kMostBytes && (ctx.maxMemory == 0 || bytes < 0.5 * double(ctx.maxMemory));
        requireMemory(ctx, bytes / (kPhases * kPhases), "the sample", "take a smaller one");
        mAxes = principalAxes(sample.values, mChannels, mChannels, 1.0 + 1e-9);
        mPlanes = std::make_unique<MatchPlanes>(rotated(sample), margin, all);
        if (coarser) {
            mCoarserPlanes =
                std::make_unique<MatchPlanes>(rotated(enlarged(*coarserSample, sample)), margin, all);
            mCoarserValues = rotated(coarser->values);
        }
        mValues = rotated(level.values);
    }

    double run() {
        std::size_t left = std::size_t(std::count(mLevel.coloured.begin(), mLevel.coloured.end(), char(0)));
        Stage stage(mContext, "matching", std::max<std::size_t>(1, left));
        RandomOrder starts(mSites.size(), mContext.seed, kStartDraw);
        const auto isFree = [&](std::uint32_t i) { return !mLevel.coloured[i]; };
        std::vector<std::uint32_t> batch;
        while (left > 0) {
            mQueue.next(mSlots.size(), mCoarser != nullptr, batch);
            if (batch.empty()) batch.push_back(starts.next(isFree));
            const std::size_t count = batch.size();
            for (std::size_t s = 0; s < count; ++s) mSlots[s].site = batch[s];
            parallelFor(mContext, count, 1, [&](std::size_t begin, std::size_t end) {
                for (std::size_t s = begin; s < end; ++s) match(mSlots[s]);
            });
            for (std::size_t s = 0; s < count; ++s) colour(mSlots[s]);
            left -= count;
            stage.advance(count);
        }
        return mCompared;
    }

private:
    std::vector<float> rotated(const std::vector<float>& values) const {
        std::vector<float> out(values.size());
        for (std::size_t i = 0; i < values.size(); i += mChannels)
            mAxes.project(values.data() + i, out.data() + i);
        return out;
    }
    SampleImage rotated(SampleImage image) const {
        image.values = rotated(image.values);
        return image;
    }

    void match(Slot& slot) const {
        gather(slot);
        slot.best = {};
        slot.compared = 0;
        if (slot.terms.empty()) {
            Random random(mContext.seed, slot.site, kTexelDraw);
            slot.best.texel = std::int32_t(random.below(std::uint32_t(mSample.texels())));
            return;
        }
        tryCandidates(slot);
        if (mOptions.coherent && slot.compared > 0) return;
        matchAll(slot.terms, mPlanes->stride(), mSample.width, slot.window, slot.best);
        const MatchWindow& w = slot.window;
        slot.compared = std::size_t(w.x1 - w.x0) * std::size_t(w.y1 - w.y0);
    }

    // The texels that coloured neighbours continue to: a good bound, and all that the coherent variant tries.
    void tryCandidates(Slot& slot) const {
        const MatchWindow& w = slot.window;
        for (const Vec2f& at : slot.candidates) {
            if (!(std::abs(at.x) < 1e9f && std::abs(at.y) < 1e9f)) continue;
            int x = int(std::floor(at.x)), y = int(std::floor(at.y));
            if (mSample.tileable) {
                x = foldedTexel(x, mSample.width, true);
                y = foldedTexel(y, mSample.height, true);
            }
            if (x < w.x0 || x >= w.x1 || y < w.y0 || y >= w.y1) continue;
            slot.best.offer(matchCost(slot.terms, y * mPlanes->stride() + x),
                            std::int32_t(y * mSample.width + x));
            ++slot.compared;
        }
    }

    // The terms of a site's neighbourhood and the texels on which it fits.
    void gather(Slot& slot) const {
        slot.neighbours.clear();
        slot.candidates.clear();
        slot.parents.clear();
        slot.window = {0, mSample.width, 0, mSample.height};
        const std::uint32_t i = slot.site;
        const SiteFrame frame = siteFrame(mSites.normal[i], mLevel.tangent[i]);
        const auto offsetTo = [&](const Vec3f& point) {
            return flattened(frame, point - mSites.point[i]) * float(1 / mLevel.texel);
        };
        if (mCoarser) slot.parents.push_back(mLevel.parent[i]);
        for (std::uint32_t k = mSites.begin[i]; k < mSites.begin[i + 1]; ++k) {
            const std::uint32_t j = mSites.neighbours[k];
            const Vec2f by = offsetTo(mSites.point[j]);
            if (!(length(by) <= mReach)) continue;
            if (mCoarser) slot.parents.push_back(mLevel.parent[j]);
            if (!mLevel.coloured[j]) continue;
            addNeighbour(slot, *mPlanes, by, mValues.data() + j * mChannels);
            slot.candidates.push_back(mLevel.coordinate[j] - by);
        }
        gatherCoarser(slot, offsetTo);
        makeTerms(slot);
        const MatchWindow& w = slot.window;
        if (mSample.tileable || w.x0 >= w.x1 || w.y0 >= w.y1)
            slot.window = {0, mSample.width, 0, mSample.height};
    }

    // The first component of all neighbours first: it tells most texels apart.
    void makeTerms(Slot& slot) const {
        slot.terms.clear();
        std::size_t room = 0;
        for (std::size_t c = 0; c < mChannels; ++c)
            for (const Neighbour& n : slot.neighbours) {
                if (room == slot.rooms.size()) slot.rooms.emplace_back();
                slot.terms.push_back({n.planes->plane(n.x8, n.y8, int(c), slot.rooms[room++]), n.values[c]});
            }
    }

    template <typename OffsetTo>
    void gatherCoarser(Slot& slot, const OffsetTo& offsetTo) const {
        std::sort(slot.parents.begin(), slot.parents.end());
        slot.parents.erase(std::unique(slot.parents.begin(), slot.parents.end()), slot.parents.end());
        for (const std::uint32_t p : slot.parents) {
            const Vec2f by = offsetTo(mCoarser->sites.point[p]);
            if (!(length(by) <= mReach)) continue;
            addNeighbour(slot, *mCoarserPlanes, by, mCoarserValues.data() + p * mChannels);
            slot.candidates.push_back(mCoarser->coordinate[p] * 2 - by);
        }
    }

    void addNeighbour(Slot& slot, const MatchPlanes& planes, const Vec2f& by, const float* values) const {
        const int x8 = int(std::floor(by.x * kPhases + 0.5f)), y8 = int(std::floor(by.y * kPhases + 0.5f));
        slot.neighbours.push_back({&planes, x8, y8, values});
        // From the first to the last texel whose place moved by the offset lies between texels' centres.
        MatchWindow& w = slot.window;
        w.x0 = std::max(w.x0, (-x8 + kPhases - 1) >> 3);
        w.y0 = std::max(w.y0, (-y8 + kPhases - 1) >> 3);
        w.x1 = std::min(w.x1, mSample.width - ((x8 + kPhases - 1) >> 3));
        w.y1 = std::min(w.y1, mSample.height - ((y8 + kPhases - 1) >> 3));
    }

    void colour(const Slot& slot) {
        const int x = slot.best.texel % mSample.width, y = slot.best.texel / mSample.width;
        mLevel.coordinate[slot.site] = {float(x) + 0.5f, float(y) + 0.5f};
        std::copy_n(
            mSample.texel(x, y), mSample.channels,
            mLevel.values.begin() + std::ptrdiff_t(std::size_t(slot.site) * std::size_t(mSample.channels)));
        mAxes.project(mSample.texel(x, y), mValues.data() + std::size_t(slot.site) * mChannels);
        mLevel.coloured[slot.site] = 1;
        mCompared += double(slot.compared);
        mQueue.raiseAround(slot.site);
    }

    MatchLevel& mLevel;
    const SurfaceSites& mSites;
    const SampleImage& mSample;
    std::size_t mChannels;
    const MatchLevel* mCoarser;
    const PointMatchingOptions& mOptions;
    const RunContext& mContext;
    MatchQueue mQueue;
    std::vector<Slot> mSlots;
    float mReach = 1;
    PrincipalAxes mAxes;
    std::vector<float> mValues, mCoarserValues;  // along the axes
    std::unique_ptr<MatchPlanes> mPlanes, mCoarserPlanes;
    double mCompared = 0;
};

}  // namespace

double matchLevel(MatchLevel& level, const SampleImage& sample, const MatchLevel* coarser,
                  const SampleImage* coarserSample, const PointMatchingOptions& options,
                  const RunContext& ctx) {
    return Matcher(level, sample, coarser, coarserSample, options, ctx).run();
}

}  // namespace vdbsynth
