#include "libvdbsynth/texture/point_hierarchy.h"

#include "libvdbsynth/texture/site_queue.h"

#include <algorithm>
#include <array>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kFree = SiteQueue::kNone;

class Merger {
public:
    Merger(const SurfaceSites& sites, const RunContext& ctx)
        : mSites(sites),
          mQueue(sites.size()),
          mStage(ctx, "clusters", std::max<std::size_t>(1, sites.size())) {
        mCoarser.parent.assign(sites.size(), kFree);
    }

    CoarserSites merge() {
        for (std::uint32_t next = 0; next < mSites.size();) {
            const std::uint32_t queued = mQueue.popMost().site;
            if (queued != SiteQueue::kNone && mCoarser.parent[queued] == kFree)
                cluster(queued);
            else if (queued == SiteQueue::kNone && mCoarser.parent[next] == kFree)
                cluster(next);
            else if (queued == SiteQueue::kNone)
                ++next;
        }
        return std::move(mCoarser);
    }

private:
    void cluster(std::uint32_t start) {
        std::array<std::uint32_t, 4> members{start};
        std::size_t count = 1;
        for (std::uint32_t k = mSites.begin[start]; k < mSites.begin[start + 1] && count < 4; ++k)
            if (mCoarser.parent[mSites.neighbours[k]] == kFree) members[count++] = mSites.neighbours[k];
        Vec3d point, normal;
        for (std::size_t m = 0; m < count; ++m) {
            point = point + cast<double>(mSites.point[members[m]]);
            normal = normal + cast<double>(mSites.normal[members[m]]);
            mCoarser.parent[members[m]] = std::uint32_t(mCoarser.point.size());
        }
        for (std::size_t m = 0; m < count; ++m) raiseAround(members[m]);
        mCoarser.point.push_back(cast<float>(point * (1.0 / double(count))));
        const Vec3f mean = normalized(cast<float>(normal));
        mCoarser.normal.push_back(dot(mean, mSites.normal[start]) > 0 ? mean : mSites.normal[start]);
        mStage.advance(count);
    }

    void raiseAround(std::uint32_t site) {
        for (std::uint32_t k = mSites.begin[site]; k < mSites.begin[site + 1]; ++k)
            if (mCoarser.parent[mSites.neighbours[k]] == kFree) mQueue.raise(mSites.neighbours[k]);
    }

    const SurfaceSites& mSites;
    SiteQueue mQueue;
    Stage mStage;
    CoarserSites mCoarser;
};

}  // namespace

CoarserSites mergedByFours(const SurfaceSites& sites, const RunContext& ctx) {
    return Merger(sites, ctx).merge();
}

}  // namespace vdbsynth
