// Regions without a bound inside, halved: each half is nearer to one of two sites far apart.
#include "libvdbsynth/points/site_regions_steps.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace vdbsynth {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

struct Step {
    double distance;
    std::uint32_t site;
    bool operator>(const Step& other) const {
        return distance != other.distance ? distance > other.distance : site > other.site;
    }
};

class Halving {
public:
    Halving(const RegionGraph& graph, std::vector<std::uint32_t>& region)
        : mGraph(graph), mRegion(region), mBegin(region.size() + 1, 0), mNext(2 * graph.edges.size()) {
        for (const RegionEdge& edge : graph.edges) {
            ++mBegin[edge.a + 1];
            ++mBegin[edge.b + 1];
        }
        for (std::size_t i = 0; i < region.size(); ++i) mBegin[i + 1] += mBegin[i];
        std::vector<std::size_t> at(mBegin.begin(), mBegin.end() - 1);
        for (const RegionEdge& edge : graph.edges) {
            mNext[at[edge.a]++] = edge.b;
            mNext[at[edge.b]++] = edge.a;
        }
    }

    // False if the region is a single site.
    bool halve(std::uint32_t region) {
        std::uint32_t lowest = 0;
        while (mRegion[lowest] != region) ++lowest;
        const std::uint32_t one = farthest(distancesFrom(lowest));
        const std::vector<double> toOne = distancesFrom(one);
        const std::uint32_t two = farthest(toOne);
        if (two == one) return false;
        const std::vector<double> toTwo = distancesFrom(two);
        std::vector<std::uint32_t> halves[2];
        for (std::uint32_t i = 0; i < mRegion.size(); ++i)
            if (mRegion[i] == region) halves[toTwo[i] < toOne[i]].push_back(i);
        for (const auto& half : halves)
            for (std::uint32_t i : half) mRegion[i] = half.front();
        return true;
    }

private:
    // Along edges inside the region of the site; kFar elsewhere.
    std::vector<double> distancesFrom(std::uint32_t from) const {
        std::vector<double> distance(mRegion.size(), kFar);
        std::priority_queue<Step, std::vector<Step>, std::greater<Step>> queue;
        distance[from] = 0;
        queue.push({0, from});
        while (!queue.empty()) {
            const Step step = queue.top();
            queue.pop();
            if (step.distance > distance[step.site]) continue;
            for (std::size_t k = mBegin[step.site]; k < mBegin[step.site + 1]; ++k) {
                const std::uint32_t next = mNext[k];
                if (mRegion[next] != mRegion[from]) continue;
                const std::vector<Vec3f>& point = mGraph.sites.point;
                const double beyond = step.distance + double(length(point[next] - point[step.site]));
                if (!(beyond < distance[next])) continue;
                distance[next] = beyond;
                queue.push({beyond, next});
            }
        }
        return distance;
    }

    static std::uint32_t farthest(const std::vector<double>& distance) {
        std::uint32_t best = 0;
        double most = -1;
        for (std::uint32_t i = 0; i < distance.size(); ++i)
            if (distance[i] < kFar && distance[i] > most) {
                most = distance[i];
                best = i;
            }
        return best;
    }

    const RegionGraph& mGraph;
    std::vector<std::uint32_t>& mRegion;
    std::vector<std::size_t> mBegin;
    std::vector<std::uint32_t> mNext;
};

}  // namespace

std::size_t halveRegions(const RegionGraph& graph, std::size_t count, std::vector<std::uint32_t>& region,
                         const RunContext& ctx) {
    Halving halving(graph, region);
    for (std::size_t times = 0;; ++times) {
        throwIfCancelled(ctx);
        std::vector<double> area(region.size(), 0);
        std::vector<std::size_t> sites(region.size(), 0);
        for (std::size_t i = 0; i < region.size(); ++i) {
            area[region[i]] += graph.area[i];
            ++sites[region[i]];
        }
        std::size_t regions = 0, largest = region.size();
        for (std::size_t r = 0; r < region.size(); ++r) {
            regions += sites[r] > 0;
            if (sites[r] > 1 && (largest == region.size() || area[r] > area[largest])) largest = r;
        }
        if (regions >= count || largest == region.size() || !halving.halve(std::uint32_t(largest)))
            return times;
    }
}

}  // namespace vdbsynth
