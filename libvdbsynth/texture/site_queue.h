#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Sites in the order of how many of their neighbours are done, most first; among equals the one that reached
/// its count first, so that regions grow round. Buckets of linked lists: every step takes constant time.
class SiteQueue {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    struct Entry {
        std::uint32_t site = kNone, count = 0;
    };

    explicit SiteQueue(std::size_t sites) : mNodes(sites) {}

    /// One more neighbour is done: the site enters with 1, or moves up.
    void raise(std::uint32_t site) {
        const std::uint32_t count = mNodes[site].count + 1;
        if (count > 1) unlink(site);
        mNodes[site].count = count;
        append(site);
    }

    /// Removes the site with the largest count and sets its count to 0. @return site kNone if there is none
    Entry popMost();

    /// Puts a site that popMost gave back to the place it had.
    void putBack(const Entry& entry);

private:
    struct Node {
        std::uint32_t previous = kNone, next = kNone, count = 0;
    };
    struct Bucket {
        std::uint32_t first = kNone, last = kNone;
    };

    void unlink(std::uint32_t site);
    void append(std::uint32_t site);
    Bucket& bucket(std::uint32_t count);

    std::vector<Node> mNodes;
    std::vector<Bucket> mBuckets;
    std::size_t mTop = 0;  // no bucket above it has a site
};

}  // namespace vdbsynth
