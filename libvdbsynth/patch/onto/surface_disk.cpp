#include "libvdbsynth/patch/onto/surface_disk.h"

#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/math/smallest_rotation.h"

#include <algorithm>
#include <queue>

namespace vdbsynth {
namespace {

// A site that a disk may take next, nearest to the centre first, ties by number.
struct Open {
    float distance;
    std::uint32_t site;
    bool operator<(const Open& other) const {
        return distance != other.distance ? distance > other.distance : site > other.site;
    }
};

}  // namespace

std::ptrdiff_t SurfaceDisk::find(std::uint32_t number) const {
    const auto found = std::lower_bound(site.begin(), site.end(), number);
    return found != site.end() && *found == number ? found - site.begin() : -1;
}

SurfaceDisks::SurfaceDisks(const OntoSurface& surface)
    : mSurface(surface), mDisk(surface.sites.size(), 0), mMember(surface.sites.size()) {}

SurfaceDisks::Member SurfaceDisks::seenFrom(std::uint32_t from, std::uint32_t to) const {
    const SurfaceSites& sites = mSurface.sites;
    const SiteFrame frame = siteFrame(sites.normal[from], mMember[from].tangent);
    return {mMember[from].at + flattened(frame, sites.point[to] - sites.point[from]),
            carried(mMember[from].tangent, sites.normal[from], sites.normal[to])};
}

SurfaceDisks::Member SurfaceDisks::mean(std::uint32_t to) const {
    const SurfaceSites& sites = mSurface.sites;
    Member sum;
    float weights = 0;
    for (std::size_t n = sites.begin[to]; n < sites.begin[to + 1]; ++n) {
        const std::uint32_t from = sites.neighbours[n];
        if (mDisk[from] != mNumber) continue;
        const Member seen = seenFrom(from, to);
        const float weight = 1 / std::max(length(sites.point[to] - sites.point[from]), 1e-12f);
        sum.at = sum.at + seen.at * weight;
        sum.tangent = sum.tangent + seen.tangent * weight;
        weights += weight;
    }
    return {sum.at * (1 / weights), tangentNear(sites.normal[to], sum.tangent)};
}

SurfaceDisk SurfaceDisks::around(std::uint32_t centre, double radius) {
    const SurfaceSites& sites = mSurface.sites;
    ++mNumber;
    SurfaceDisk disk;
    disk.centre = centre;
    std::priority_queue<Open> open;
    const auto add = [&](std::uint32_t site, const Member& member) {
        mDisk[site] = mNumber;
        mMember[site] = member;
        disk.site.push_back(site);
        for (std::size_t n = sites.begin[site]; n < sites.begin[site + 1]; ++n) {
            const std::uint32_t to = sites.neighbours[n];
            if (mDisk[to] == mNumber) continue;
            const float distance = length(seenFrom(site, to).at);
            if (distance <= float(radius)) open.push({distance, to});
        }
    };
    add(centre, {{0, 0}, mSurface.tangent[centre]});
    while (!open.empty()) {
        const std::uint32_t site = open.top().site;
        open.pop();
        if (mDisk[site] == mNumber) continue;
        const Member member = mean(site);
        if (length(member.at) <= float(radius)) add(site, member);
    }
    std::sort(disk.site.begin(), disk.site.end());
    for (const std::uint32_t site : disk.site) {
        disk.at.push_back(mMember[site].at);
        disk.turn.push_back(frameRotation(siteFrame(sites.normal[site], mMember[site].tangent),
                                          siteFrame(sites.normal[site], mSurface.tangent[site])));
    }
    return disk;
}

}  // namespace vdbsynth
