#include "libvdbsynth/texture/site_queue.h"

#include <algorithm>

namespace vdbsynth {

SiteQueue::Bucket& SiteQueue::bucket(std::uint32_t count) {
    if (count >= mBuckets.size()) mBuckets.resize(std::size_t(count) + 1);
    mTop = std::max(mTop, std::size_t(count));
    return mBuckets[count];
}

void SiteQueue::unlink(std::uint32_t site) {
    const Node node = mNodes[site];
    Bucket& from = mBuckets[node.count];
    (node.previous == kNone ? from.first : mNodes[node.previous].next) = node.next;
    (node.next == kNone ? from.last : mNodes[node.next].previous) = node.previous;
}

void SiteQueue::append(std::uint32_t site) {
    Node& node = mNodes[site];
    Bucket& to = bucket(node.count);
    node.previous = to.last;
    node.next = kNone;
    (to.last == kNone ? to.first : mNodes[to.last].next) = site;
    to.last = site;
}

SiteQueue::Entry SiteQueue::popMost() {
    while (mTop > 0 && mBuckets[mTop].first == kNone) --mTop;
    if (mTop == 0) return {};
    const Entry entry{mBuckets[mTop].first, std::uint32_t(mTop)};
    unlink(entry.site);
    mNodes[entry.site].count = 0;
    return entry;
}

void SiteQueue::putBack(const Entry& entry) {
    Node& node = mNodes[entry.site];
    Bucket& to = bucket(entry.count);
    node = {kNone, to.first, entry.count};
    (to.first == kNone ? to.last : mNodes[to.first].previous) = entry.site;
    to.first = entry.site;
}

}  // namespace vdbsynth
