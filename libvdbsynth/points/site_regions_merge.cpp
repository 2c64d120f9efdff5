// Regions merged across their weakest borders, small ones first.
#include "libvdbsynth/points/site_regions_steps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>

namespace vdbsynth {
namespace {

constexpr double kCurvature = 0.5;  // weight of a difference of curvatures beside one of normals
constexpr double kDistinct = 2;     // a border's mean difference over that inside either region

struct Mean {
    double sum = 0, count = 0;

    void add(const Mean& other) {
        sum += other.sum;
        count += other.count;
    }
    double value() const { return count > 0 ? sum / count : 0; }
};

struct Region {
    double area = 0, curvature = 0;  // the curvature times the area
    Mean inside;
    double around = 0;                      // edges that leave it
    std::map<std::uint32_t, Mean> borders;  // by the other's number
    std::uint32_t into = 0;                 // itself, or the region that it was merged into
};

struct Pair {
    double cost;
    std::uint32_t a, b;
    bool operator>(const Pair& other) const {
        return std::tie(cost, a, b) > std::tie(other.cost, other.a, other.b);
    }
};

class Merging {
public:
    Merging(const RegionGraph& graph, const std::vector<std::uint32_t>& region) : mRegions(region.size()) {
        for (std::uint32_t i = 0; i < region.size(); ++i) {
            mRegions[i].into = i;
            mCount += region[i] == i;
            mRegions[region[i]].area += graph.area[i];
            mRegions[region[i]].curvature += graph.area[i] * graph.curvature[i];
        }
        for (const RegionEdge& edge : graph.edges) {
            const std::uint32_t a = region[edge.a], b = region[edge.b];
            const Mean one{double(edge.difference), 1};
            if (a == b) {
                mRegions[a].inside.add(one);
            } else {
                mRegions[a].borders[b].add(one);
                mRegions[b].borders[a].add(one);
                ++mRegions[a].around;
                ++mRegions[b].around;
            }
        }
        for (std::uint32_t a = 0; a < mRegions.size(); ++a)
            for (const auto& [b, border] : mRegions[a].borders)
                if (a < b) push(a, b);
    }

    void mergeTo(std::size_t count, const RunContext& ctx) {
        std::size_t steps = 0;
        while (mCount > count && !mPairs.empty()) {
            if (++steps % 4096 == 0) throwIfCancelled(ctx);
            const Pair least = mPairs.top();
            mPairs.pop();
            if (!alive(least.a) || !alive(least.b)) continue;
            // What either became since may have raised its cost.
            const double cost = costOf(least.a, least.b);
            if (cost > least.cost)
                mPairs.push({cost, least.a, least.b});
            else
                merge(least.a, least.b);
        }
    }

    void mergeIndistinct() {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::uint32_t a = 0; a < mRegions.size() && !changed; ++a)
                for (const auto& [b, border] : mRegions[a].borders) {
                    if (b < a || distinct(a, b)) continue;
                    merge(a, b);
                    changed = true;
                    break;
                }
        }
    }

    std::uint32_t of(std::uint32_t region) const {
        while (mRegions[region].into != region) region = mRegions[region].into;
        return region;
    }

private:
    bool alive(std::uint32_t a) const { return mRegions[a].into == a; }

    double strength(std::uint32_t a, std::uint32_t b) const {
        const Region &p = mRegions[a], &q = mRegions[b];
        return p.borders.at(b).value() + kCurvature * std::abs(p.curvature / p.area - q.curvature / q.area);
    }
    double costOf(std::uint32_t a, std::uint32_t b) const {
        const Region& less = mRegions[a].area < mRegions[b].area ? mRegions[a] : mRegions[b];
        return strength(a, b) * std::sqrt(less.area) * less.around / mRegions[a].borders.at(b).count;
    }
    bool distinct(std::uint32_t a, std::uint32_t b) const {
        return strength(a, b) > kDistinct * std::min(mRegions[a].inside.value(), mRegions[b].inside.value());
    }
    void push(std::uint32_t a, std::uint32_t b) {
        mPairs.push({costOf(a, b), std::min(a, b), std::max(a, b)});
    }

    // The one with fewer borders goes into the other, so that each border moves a logarithmic number of
    // times.
    void merge(std::uint32_t a, std::uint32_t b) {
        if (mRegions[a].borders.size() < mRegions[b].borders.size()) std::swap(a, b);
        Region &kept = mRegions[a], &gone = mRegions[b];
        kept.area += gone.area;
        kept.curvature += gone.curvature;
        kept.inside.add(gone.inside);
        kept.inside.add(kept.borders.at(b));
        kept.around += gone.around - 2 * kept.borders.at(b).count;
        kept.borders.erase(b);
        for (const auto& [c, border] : gone.borders) {
            if (c == a) continue;
            mRegions[c].borders.erase(b);
            kept.borders[c].add(border);
            mRegions[c].borders[a] = kept.borders[c];
        }
        for (const auto& [c, border] : gone.borders)
            if (c != a) push(a, c);
        gone.borders.clear();
        gone.into = a;
        --mCount;
    }

    std::vector<Region> mRegions;
    std::size_t mCount = 0;
    std::priority_queue<Pair, std::vector<Pair>, std::greater<Pair>> mPairs;
};

}  // namespace

void mergeRegions(const RegionGraph& graph, std::size_t count, std::vector<std::uint32_t>& region,
                  const RunContext& ctx) {
    Merging merging(graph, region);
    merging.mergeTo(count, ctx);
    merging.mergeIndistinct();
    for (std::uint32_t& r : region) r = merging.of(r);
}

}  // namespace vdbsynth
