#pragma once
#include "libvdbsynth/relief/growth/grown_relief.h"

#include <set>

// The steps of growRelief, which several files share.
namespace vdbsynth {

/// The site of the sample that the seed patch is copied from, by the options.
/// @param radius  [world] of the patch
std::uint32_t seedOfSample(const ReliefSites& sample, double radius, std::int64_t seedSite,
                           const RunContext& ctx);

/// Sites without displacement in the order of growth.
class GrowthQueue {
public:
    /// @param neighbourhoods  borrowed
    explicit GrowthQueue(const ReliefNeighbourhoods& neighbourhoods, std::size_t sites);

    /// The site has its displacement: it leaves, and the sites of whose N it is a member move up.
    void done(std::uint32_t site);
    /// The site with the most textured neighbours, the lowest number of several. @return false if none has
    /// any
    bool next(std::uint32_t& site) const;
    bool isDone(std::uint32_t site) const { return mDone[site] != 0; }
    const char* allDone() const { return mDone.data(); }

private:
    struct Entry {
        std::uint32_t count, site;
        bool operator<(const Entry& other) const {
            return count != other.count ? count > other.count : site < other.site;
        }
    };
    std::vector<std::size_t> mBegin;  // the neighbourhoods' inverse: of v the sites t with v in N(t)
    std::vector<std::uint32_t> mInverse, mCount;
    std::vector<char> mDone;
    std::set<Entry> mOpen;
};

/// The flattest open site: the largest sum of n_v . n_t over N(t) and t, so of a whole neighbourhood before
/// one at a border; ties by number. [0..]
std::vector<float> flatness(const SurfaceSites& sites, const ReliefNeighbourhoods& neighbourhoods);

}  // namespace vdbsynth
