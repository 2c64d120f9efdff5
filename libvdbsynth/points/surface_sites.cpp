#include "libvdbsynth/points/surface_sites.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/geometry/point_neighbours.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace vdbsynth {
namespace {

constexpr int kBits = 21;  // of a Morton code, per axis

// Every third bit of a number of 21.
std::uint64_t spread(std::uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffffull;
    x = (x | x << 16) & 0x1f0000ff0000ffull;
    x = (x | x << 8) & 0x100f00f00f00f00full;
    x = (x | x << 4) & 0x10c30c30c30c30c3ull;
    return (x | x << 2) & 0x1249249249249249ull;
}

// The cube that the curve fills: cells of side `step` at the finest of 2^21.
struct MortonBox {
    Vec3f low;
    double step = 0;

    explicit MortonBox(const std::vector<Vec3f>& points) {
        if (points.empty()) return;
        low = points[0];
        Vec3f high = low;
        for (const Vec3f& p : points)
            for (int a = 0; a < 3; ++a) {
                low[a] = std::min(low[a], p[a]);
                high[a] = std::max(high[a], p[a]);
            }
        double side = 0;
        for (int a = 0; a < 3; ++a) side = std::max(side, double(high[a]) - double(low[a]));
        step = side / double((1 << kBits) - 1);
    }
    std::uint32_t cell(const Vec3f& p, int axis) const {
        return step > 0 ? std::uint32_t((double(p[axis]) - double(low[axis])) / step) : 0;
    }
    std::uint64_t code(const Vec3f& p) const {
        return spread(cell(p, 0)) << 2 | spread(cell(p, 1)) << 1 | spread(cell(p, 2));
    }
};

struct Coded {
    std::uint64_t code;
    std::uint32_t number;
    bool operator<(const Coded& other) const {
        return code != other.code ? code < other.code : number < other.number;
    }
};

std::vector<Coded> codedPoints(const std::vector<Vec3f>& points, const MortonBox& box,
                               const RunContext& ctx) {
    std::vector<Coded> coded(points.size());
    parallelFor(ctx, points.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) coded[i] = {box.code(points[i]), std::uint32_t(i)};
    });
    parallelSort(ctx, coded);
    return coded;
}

struct Near {
    float squared;
    std::uint32_t number;
    bool operator<(const Near& other) const {
        return squared != other.squared ? squared < other.squared : number < other.number;
    }
};

// The nearest points of each in a kd-tree, asked for in Morton order, so that the tree's nodes stay in the
// cache (measured: a hashed grid of cells is slower).
class Finder {
public:
    Finder(const SurfaceSites& sites, std::size_t count) : mSites(sites), mCount(count), mTree(sites.point) {}

    void around(std::uint32_t i, std::vector<Near>& near, std::vector<std::uint32_t>& numbers,
                std::vector<float>& squared) const {
        const std::size_t all = mSites.size(), most = std::min(all, 16 * mCount + 64);
        numbers.resize(most);
        squared.resize(most);
        for (std::size_t ask = std::min(all, mCount + 2);; ask = std::min(most, 3 * ask)) {
            const std::size_t got = mTree.nearest(mSites.point[i], ask, numbers.data(), squared.data());
            near.clear();
            for (std::size_t k = 0; k < got; ++k)
                if (squared[k] > 0 && dot(mSites.normal[i], mSites.normal[numbers[k]]) > 0)
                    near.push_back({squared[k], numbers[k]});
            // The farthest found may be one of several at its distance: those that were asked for beyond
            // the count settle which come first.
            if (ask >= most || (near.size() >= mCount && squared[got - 1] > near[mCount - 1].squared)) break;
        }
        std::sort(near.begin(), near.end());
        if (near.size() > mCount) near.resize(mCount);
    }

private:
    const SurfaceSites& mSites;
    std::size_t mCount;
    PointNeighbours mTree;
};

// The neighbours of all sites, `count` slots each; the number found in `found`.
void findAll(const SurfaceSites& sites, std::size_t count, std::vector<std::uint32_t>& slots,
             std::vector<std::uint32_t>& found, const RunContext& ctx) {
    const std::vector<std::uint32_t> order = mortonOrder(sites.point, ctx);
    const Finder finder(sites, count);
    parallelFor(ctx, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
        std::vector<Near> near;
        std::vector<std::uint32_t> numbers;
        std::vector<float> squared;
        for (std::size_t at = begin; at < end; ++at) {
            const std::uint32_t i = order[at];
            finder.around(i, near, numbers, squared);
            found[i] = std::uint32_t(near.size());
            for (std::size_t k = 0; k < near.size(); ++k) slots[i * count + k] = near[k].number;
        }
    });
}

}  // namespace

SurfaceSites sitesOfPoints(std::vector<Vec3f> points, std::vector<Vec3f> normals, std::size_t count,
                           const RunContext& ctx) {
    if (count < 1 || count > 256)
        throw Error(ErrorCode::InvalidOption,
                    "`neighbours`: " + std::to_string(count) + " is not between 1 and 256");
    if (points.size() != normals.size())
        throw Error(ErrorCode::ShapeMismatch, "there are " + std::to_string(points.size()) + " points but " +
                                                  std::to_string(normals.size()) + " normals");
    SurfaceSites sites;
    sites.point = std::move(points);
    sites.normal = std::move(normals);
    const std::size_t n = sites.size();
    sites.begin.assign(n + 1, 0);
    if (n < 2) return sites;
    std::vector<std::uint32_t> slots(n * count), found(n);
    findAll(sites, count, slots, found, ctx);
    for (std::size_t i = 0; i < n; ++i) sites.begin[i + 1] = sites.begin[i] + found[i];
    sites.neighbours.resize(sites.begin[n]);
    parallelFor(ctx, n, 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            std::copy_n(slots.data() + i * count, found[i], sites.neighbours.data() + sites.begin[i]);
    });
    return sites;
}

double meanNearestDistance(const SurfaceSites& sites) {
    double sum = 0;
    std::size_t counted = 0;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        if (sites.degree(i) == 0) continue;
        sum += double(length(sites.point[sites.neighbours[sites.begin[i]]] - sites.point[i]));
        ++counted;
    }
    return counted > 0 ? sum / double(counted) : 0;
}

std::vector<std::uint32_t> mortonOrder(const std::vector<Vec3f>& points, const RunContext& ctx) {
    const MortonBox box(points);
    const std::vector<Coded> coded = codedPoints(points, box, ctx);
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = coded[i].number;
    return order;
}

}  // namespace vdbsynth
