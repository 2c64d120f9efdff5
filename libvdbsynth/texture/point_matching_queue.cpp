#include "libvdbsynth/texture/point_matching_steps.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr std::size_t kLookedAt = 64;  // sites, to find those that are not neighbours

}  // namespace

MatchQueue::MatchQueue(const MatchLevel& level)
    : mLevel(level), mSites(level.sites), mQueue(level.sites.size()), mMark(level.sites.size(), 0) {
    for (std::uint32_t i = 0; i < mSites.size(); ++i)
        if (level.coloured[i]) raiseAround(i);
}

void MatchQueue::raiseAround(std::uint32_t site) {
    for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
        if (!mLevel.coloured[mSites.neighbours[k]]) mQueue.raise(mSites.neighbours[k]);
}

void MatchQueue::next(std::size_t most, bool all, std::vector<std::uint32_t>& sites) {
    sites.clear();
    std::uint32_t first = 0;
    ++mBatch;
    while (sites.size() < most && mAside.size() + sites.size() < kLookedAt) {
        const SiteQueue::Entry entry = mQueue.popMost();
        if (entry.site == SiteQueue::kNone) break;
        if (!all && !seesColour(entry.site)) continue;  // only seen by some; it comes again
        if (sites.empty()) first = entry.count;
        const bool few = 4 * entry.count < 3 * first;
        if (few || besideBatch(entry.site)) {
            mAside.push_back(entry);
            if (few) break;
            continue;
        }
        mark(entry.site);
        sites.push_back(entry.site);
    }
    for (; !mAside.empty(); mAside.pop_back()) mQueue.putBack(mAside.back());
}

bool MatchQueue::seesColour(std::uint32_t site) const {
    const auto first = mSites.neighbours.begin() + mSites.begin[site];
    return std::any_of(first, first + std::ptrdiff_t(mSites.degree(site)),
                       [&](std::uint32_t j) { return mLevel.coloured[j] != 0; });
}

bool MatchQueue::besideBatch(std::uint32_t site) const {
    if (mMark[site] >= 2 * mBatch) return true;
    for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
        if (mMark[mSites.neighbours[k]] == 2 * mBatch + 1) return true;
    return false;
}

void MatchQueue::mark(std::uint32_t site) {
    mMark[site] = 2 * mBatch + 1;
    for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k) {
        std::uint64_t& beside = mMark[mSites.neighbours[k]];
        beside = std::max(beside, 2 * mBatch);
    }
}

}  // namespace vdbsynth
