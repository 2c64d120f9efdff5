#include "libvdbsynth/base/random.h"
#include "libvdbsynth/relief/growth/grown_relief_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kDrawsSeed = 0x72736431;  // purpose of the random numbers

// Mean and mean square of heights along the normals over a site and its neighbourhood.
struct Heights {
    double mean = 0, square = 0;
};

Heights heightsAround(const std::vector<float>& height, const ReliefNeighbourhoods& patches,
                      std::size_t site) {
    Heights sum{double(height[site]), double(height[site]) * double(height[site])};
    for (std::size_t k = patches.begin[site]; k < patches.begin[site + 1]; ++k) {
        const double h = double(height[patches.member[k]]);
        sum.mean += h;
        sum.square += h * h;
    }
    const double count = double(patches.size(site) + 1);
    return {sum.mean / count, sum.square / count};
}

// The site whose patch is most like the whole.
std::uint32_t mostTypical(const ReliefSites& sample, const ReliefNeighbourhoods& patches) {
    const std::size_t n = sample.sites.size();
    std::vector<float> height(n);
    Heights all;
    for (std::size_t i = 0; i < n; ++i) {
        height[i] = dot(sample.displacement[i], sample.sites.normal[i]);
        all.mean += double(height[i]) / double(n);
        all.square += double(height[i]) * double(height[i]) / double(n);
    }
    std::vector<std::size_t> counts(n);
    for (std::size_t i = 0; i < n; ++i) counts[i] = patches.size(i);
    std::nth_element(counts.begin(), counts.begin() + std::ptrdiff_t(n / 2), counts.end());
    const double whole = 0.9 * double(counts[n / 2]);  // a patch with fewer sites is cut by a border
    const double unit = all.square > 0 ? all.square : 1;
    std::uint32_t best = 0;
    double least = -1;
    for (std::size_t i = 0; i < n; ++i) {
        if (double(patches.size(i)) < whole) continue;
        const Heights h = heightsAround(height, patches, i);
        const double mean = h.mean - all.mean, root = std::sqrt(h.square) - std::sqrt(all.square);
        const double difference = (mean * mean + root * root) / unit;
        if (least < 0 || difference < least) {
            least = difference;
            best = std::uint32_t(i);
        }
    }
    return best;
}

}  // namespace

std::uint32_t seedOfSample(const ReliefSites& sample, double radius, std::int64_t seedSite,
                           const RunContext& ctx) {
    if (seedSite >= 0) return std::uint32_t(seedSite);
    if (seedSite == kRandomSeed)
        return Random(ctx.seed, 0, kDrawsSeed).below(std::uint32_t(sample.sites.size()));
    return mostTypical(sample, reliefNeighbourhoods(sample.sites, radius, 1, ctx));
}

GrowthQueue::GrowthQueue(const ReliefNeighbourhoods& neighbourhoods, std::size_t sites)
    : mBegin(sites + 1, 0), mInverse(neighbourhoods.member.size()), mCount(sites, 0), mDone(sites, 0) {
    for (std::uint32_t v : neighbourhoods.member) ++mBegin[v + 1];
    for (std::size_t i = 0; i < sites; ++i) mBegin[i + 1] += mBegin[i];
    std::vector<std::size_t> at(mBegin.begin(), mBegin.end() - 1);
    for (std::size_t t = 0; t < sites; ++t)
        for (std::size_t k = neighbourhoods.begin[t]; k < neighbourhoods.begin[t + 1]; ++k)
            mInverse[at[neighbourhoods.member[k]]++] = std::uint32_t(t);
}

void GrowthQueue::done(std::uint32_t site) {
    if (mDone[site]) return;
    if (mCount[site] > 0) mOpen.erase({mCount[site], site});
    mDone[site] = 1;
    for (std::size_t k = mBegin[site]; k < mBegin[site + 1]; ++k) {
        const std::uint32_t t = mInverse[k];
        if (mDone[t]) continue;
        if (mCount[t] > 0) mOpen.erase({mCount[t], t});
        mOpen.insert({++mCount[t], t});
    }
}

bool GrowthQueue::next(std::uint32_t& site) const {
    if (mOpen.empty()) return false;
    site = mOpen.begin()->site;
    return true;
}

std::vector<float> flatness(const SurfaceSites& sites, const ReliefNeighbourhoods& neighbourhoods) {
    std::vector<float> flat(sites.size());
    for (std::size_t t = 0; t < sites.size(); ++t) {
        double sum = 1;
        for (std::size_t k = neighbourhoods.begin[t]; k < neighbourhoods.begin[t + 1]; ++k)
            sum += double(dot(sites.normal[t], sites.normal[neighbourhoods.member[k]]));
        flat[t] = float(sum);
    }
    return flat;
}

}  // namespace vdbsynth
