#include "libvdbsynth/texture/site_queue.h"

#include "libvdbsynth/base/random.h"

#include <catch2/catch.hpp>

#include <vector>

using namespace vdbsynth;

TEST_CASE("SiteQueue: most first, then who reached its count first") {
    SiteQueue queue(5);
    CHECK(queue.popMost().site == SiteQueue::kNone);
    for (const std::uint32_t site : {3u, 1u, 4u, 1u, 4u, 2u}) queue.raise(site);
    const SiteQueue::Entry first = queue.popMost();
    CHECK(first.site == 1);
    CHECK(first.count == 2);
    CHECK(queue.popMost().site == 4);
    CHECK(queue.popMost().site == 3);
    queue.raise(1);  // popped sites begin anew
    queue.raise(2);
    CHECK(queue.popMost().site == 2);
    CHECK(queue.popMost().site == 1);
    CHECK(queue.popMost().site == SiteQueue::kNone);
}

TEST_CASE("SiteQueue: putBack restores the order") {
    SiteQueue queue(4);
    for (const std::uint32_t site : {0u, 1u, 2u, 3u, 3u}) queue.raise(site);
    const SiteQueue::Entry three = queue.popMost(), zero = queue.popMost();
    queue.putBack(zero);
    queue.putBack(three);
    queue.raise(1);  // joins 3 at the end of its bucket
    for (const std::uint32_t site : {3u, 1u, 0u, 2u}) CHECK(queue.popMost().site == site);
}

TEST_CASE("SiteQueue: the same as a linear scan") {
    constexpr std::uint32_t kSites = 40;
    SiteQueue queue(kSites);
    std::vector<std::pair<std::uint32_t, std::uint64_t>> reached(kSites);  // count, when
    Random random(5, 0);
    for (std::uint64_t step = 1; step < 4000; ++step) {
        if (random.below(5) > 0) {
            const std::uint32_t site = random.below(kSites);
            queue.raise(site);
            reached[site] = {reached[site].first + 1, step};
            continue;
        }
        std::uint32_t best = SiteQueue::kNone;
        for (std::uint32_t i = 0; i < kSites; ++i) {
            if (reached[i].first == 0) continue;
            if (best == SiteQueue::kNone || reached[i].first > reached[best].first ||
                (reached[i].first == reached[best].first && reached[i].second < reached[best].second))
                best = i;
        }
        REQUIRE(queue.popMost().site == best);
        if (best != SiteQueue::kNone) reached[best] = {};
    }
}
