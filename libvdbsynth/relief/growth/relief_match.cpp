#include "libvdbsynth/relief/growth/relief_match.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kGrain = 512;  // sites of the sample that one thread looks at together

// The smallest so far, the largest of them on top.
class Smallest {
public:
    Smallest(std::size_t count, float bound) : mCount(count), mBound(bound) {}

    // A cost over it is none of the smallest.
    float most() const { return mHeap.size() < mCount ? mBound : std::min(mBound, mHeap.front().cost); }

    void offer(const ReliefMatch& match) {
        if (match.cost > mBound) return;
        if (mHeap.size() == mCount) {
            if (!(match < mHeap.front())) return;
            std::pop_heap(mHeap.begin(), mHeap.end());
            mHeap.pop_back();
        }
        mHeap.push_back(match);
        std::push_heap(mHeap.begin(), mHeap.end());
    }
    const std::vector<ReliefMatch>& all() const { return mHeap; }

private:
    std::size_t mCount;
    float mBound;
    std::vector<ReliefMatch> mHeap;
};

// What is summed over sites, in chunks that do not depend on the threads.
struct Sums {
    double mean = 0;
    std::size_t capped = 0, inside = 0, outside = 0, sites = 0;
};

// Adds one site. `frame` in voxels.
void addSite(const ReliefMatcher& matcher, const ReliefFrame& frame, const std::vector<ReliefTerm>& terms,
             Sums& sums) {
    const ReliefDistance& distance = matcher.distance();
    const float most = distance.halfWidth() * distance.halfWidth();
    double cost = 0, weights = 0;
    for (const ReliefTerm& term : terms) {
        const Vec3f place = frame.point + frame.toWorld(term.place);
        if (!distance.inBox(place)) {
            ++sums.outside;
            continue;
        }
        ++sums.inside;
        const float squared = distance.squared(place);
        cost += double(term.weight) * double(squared);
        weights += double(term.weight);
        if (squared >= most) ++sums.capped;
    }
    if (!(weights > 0)) return;
    ++sums.sites;
    sums.mean += cost / weights;
}

// Over all sites; `placeOf(t, terms)` gives the frame, in voxels, that N(t) is mapped to.
template <typename PlaceOf>
ReliefMismatch mismatchOver(const ReliefSites& surface, const ReliefMatcher& matcher,
                            const ReliefNeighbourhoods& neighbourhoods, const RunContext& ctx,
                            const PlaceOf& placeOf) {
    constexpr std::size_t kSites = 64;
    const std::size_t n = surface.sites.size();
    const std::vector<ReliefFrame> frames = reliefFrames(surface.sites, surface.tangent, ctx);
    std::vector<Sums> sums((n + kSites - 1) / kSites);
    parallelFor(ctx, n, kSites, [&](std::size_t begin, std::size_t end) {
        std::vector<ReliefTerm> terms;
        for (std::size_t t = begin; t < end; ++t) {
            matcher.terms(frames[t], surface.sites, surface.displacement, neighbourhoods, t, nullptr, terms);
            if (!terms.empty()) addSite(matcher, placeOf(t, terms), terms, sums[begin / kSites]);
        }
    });
    Sums all;
    for (const Sums& part : sums) {
        all.mean += part.mean;
        all.capped += part.capped;
        all.inside += part.inside;
        all.outside += part.outside;
        all.sites += part.sites;
    }
    ReliefMismatch result;
    result.sites = all.sites;
    const double voxel = matcher.distance().voxel();
    if (all.sites > 0) result.mean = all.mean / double(all.sites) * voxel * voxel;
    if (all.inside > 0) result.capped = double(all.capped) / double(all.inside);
    if (all.inside + all.outside > 0) result.outside = double(all.outside) / double(all.inside + all.outside);
    return result;
}

}  // namespace

ReliefMatcher::ReliefMatcher(std::vector<ReliefFrame> frames, const ReliefDistance& distance)
    : mFrames(std::move(frames)), mDistance(&distance) {
    for (ReliefFrame& frame : mFrames) frame.point = distance.toVoxels(frame.point);
}

void ReliefMatcher::terms(const ReliefFrame& frame, const SurfaceSites& sites,
                          const std::vector<Vec3f>& displacement, const ReliefNeighbourhoods& neighbourhoods,
                          std::size_t t, const char* done, std::vector<ReliefTerm>& out) const {
    out.clear();
    const float voxels = float(1 / mDistance->voxel());
    for (std::size_t k = neighbourhoods.begin[t]; k < neighbourhoods.begin[t + 1]; ++k) {
        const std::uint32_t v = neighbourhoods.member[k];
        if (done && !done[v]) continue;
        const Vec3f way = sites.point[v] - frame.point + displacement[v];
        out.push_back({frame.toLocal(way) * voxels, neighbourhoods.weight[k]});
    }
}

std::vector<ReliefMatch> ReliefMatcher::best(const std::vector<ReliefTerm>& terms, std::size_t count,
                                             const std::vector<std::uint32_t>& likely,
                                             const RunContext& ctx) const {
    constexpr float kNone = std::numeric_limits<float>::infinity();
    count = std::min(count, size());
    if (count == 0) return {};
    std::vector<std::uint32_t> once = likely;
    std::sort(once.begin(), once.end());
    once.erase(std::unique(once.begin(), once.end()), once.end());
    Smallest first(count, kNone);
    for (std::uint32_t site : once) first.offer({cost(mFrames[site], terms, first.most()), site});
    const float bound = first.all().size() == count ? first.most() : kNone;
    std::vector<std::vector<ReliefMatch>> parts((size() + kGrain - 1) / kGrain);
    parallelFor(ctx, size(), kGrain, [&](std::size_t begin, std::size_t end) {
        Smallest smallest(count, bound);
        for (std::size_t s = begin; s < end; ++s)
            smallest.offer({cost(mFrames[s], terms, smallest.most()), std::uint32_t(s)});
        parts[begin / kGrain] = smallest.all();
    });
    std::vector<ReliefMatch> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    all.resize(count);
    return all;
}

ReliefMismatch assignedMismatch(const ReliefSites& surface, const std::vector<ReliefFrame>& source,
                                const ReliefDistance& distance, const ReliefNeighbourhoods& neighbourhoods,
                                const RunContext& ctx) {
    requireReliefSites(surface, "the surface");
    if (source.size() != surface.sites.size())
        throw Error(ErrorCode::ShapeMismatch, "the surface has " + std::to_string(surface.sites.size()) +
                                                  " sites but " + std::to_string(source.size()) + " sources");
    return withThreads(ctx, [&] {
        const ReliefMatcher matcher(source, distance);
        return mismatchOver(surface, matcher, neighbourhoods, ctx,
                            [&](std::size_t t, const std::vector<ReliefTerm>&) { return matcher.frame(t); });
    });
}

ReliefMismatch bestMismatch(const ReliefSites& surface, const ReliefSites& sample,
                            const ReliefDistance& distance, const ReliefNeighbourhoods& neighbourhoods,
                            const RunContext& ctx) {
    requireReliefSites(surface, "the surface");
    requireSites(sample.sites, sample.tangent, "the sample");
    return withThreads(ctx, [&] {
        const ReliefMatcher matcher(reliefFrames(sample.sites, sample.tangent, ctx), distance);
        return mismatchOver(surface, matcher, neighbourhoods, ctx,
                            [&](std::size_t, const std::vector<ReliefTerm>& terms) {
                                return matcher.frame(matcher.best(terms, 1, {}, ctx)[0].site);
                            });
    });
}

}  // namespace vdbsynth
