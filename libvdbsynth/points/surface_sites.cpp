#include "libvdbsynth/points/surface_sites.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/geometry/point_neighbours.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

namespace vdbsynth {
namespace {

constexpr std::size_t kCrowded = 64;  // points in a cell from which on the kd-tree is faster
constexpr int kRings = 3;             // of cells around a point's that are looked at
constexpr int kBits = 21;             // of a Morton code, per axis

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

// The points in Morton order and the cells of the finest level at which a cell holds `wanted` on average.
struct Cells {
    MortonBox box;
    std::vector<Coded> coded;
    std::vector<Vec3f> point, normal;  // in the order of `coded`
    int shift = 0;                     // bits of a cell's side
    std::vector<std::uint32_t> begin;  // of each cell, in the order of `coded`
    std::unordered_map<std::uint64_t, std::uint32_t> numbers;

    Cells(const SurfaceSites& sites, double wanted, const RunContext& ctx)
        : box(sites.point), coded(codedPoints(sites.point, box, ctx)) {
        point.resize(coded.size());
        normal.resize(coded.size());
        for (std::size_t i = 0; i < coded.size(); ++i) {
            point[i] = sites.point[coded[i].number];
            normal[i] = sites.normal[coded[i].number];
        }
        while (shift < kBits && double(coded.size()) < wanted * double(countAt(shift))) ++shift;
        for (std::uint32_t i = 0; i < coded.size(); ++i)
            if (i == 0 || cellOf(i) != cellOf(i - 1)) {
                numbers.emplace(cellOf(i), std::uint32_t(begin.size()));
                begin.push_back(i);
            }
        begin.push_back(std::uint32_t(coded.size()));
    }
    std::uint64_t cellOf(std::uint32_t i) const { return coded[i].code >> (3 * shift); }
    std::size_t countAt(int level) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < coded.size(); ++i)
            count += i == 0 || coded[i].code >> (3 * level) != coded[i - 1].code >> (3 * level);
        return count;
    }
    double side() const { return box.step * double(1u << shift); }
};

struct Near {
    float squared;
    std::uint32_t number;
    bool operator<(const Near& other) const {
        return squared != other.squared ? squared < other.squared : number < other.number;
    }
};

class Finder {
public:
    Finder(const SurfaceSites& sites, std::size_t count, const RunContext& ctx)
        : mSites(sites), mCount(count), mCells(sites, double(count) / 6 + 1, ctx), mTree(sites.point) {}

    std::size_t cells() const { return mCells.begin.size() - 1; }

    // The neighbours of all points of a cell: found(point, neighbours in order).
    template <typename Found>
    void around(std::size_t cell, Found&& found) const {
        const std::uint32_t first = mCells.begin[cell], last = mCells.begin[cell + 1];
        std::vector<Near> near;
        if (last - first > kCrowded) {
            for (std::uint32_t i = first; i < last; ++i) {
                byTree(i, near);
                found(mCells.coded[i].number, near);
            }
            return;
        }
        std::vector<std::uint32_t> members[kRings + 1];
        int gathered = -1;
        for (std::uint32_t i = first; i < last; ++i) {
            if (!byCells(i, members, gathered, near)) byTree(i, near);
            found(mCells.coded[i].number, near);
        }
    }

private:
    bool isNeighbour(std::uint32_t i, std::uint32_t j, float squared) const {
        return squared > 0 && dot(mCells.normal[i], mCells.normal[j]) > 0;
    }

    // Points of the cells at Chebyshev distance `ring`.
    void gather(std::uint32_t i, int ring, std::vector<std::uint32_t>& members) const {
        const Vec3f& p = mCells.point[i];
        const std::int64_t most = (std::int64_t(1) << kBits) >> mCells.shift;
        std::int64_t at[3];
        for (int a = 0; a < 3; ++a) at[a] = mCells.box.cell(p, a) >> mCells.shift;
        members.clear();
        const std::int64_t r = ring;
        for (std::int64_t x = at[0] - r; x <= at[0] + r; ++x)
            for (std::int64_t y = at[1] - r; y <= at[1] + r; ++y) {
                const bool side = std::abs(x - at[0]) == r || std::abs(y - at[1]) == r;
                const std::int64_t step = side || r == 0 ? 1 : 2 * r;
                for (std::int64_t z = at[2] - r; z <= at[2] + r; z += step) {
                    if (x < 0 || y < 0 || z < 0 || x > most || y > most || z > most) continue;
                    const auto entry =
                        mCells.numbers.find(spread(std::uint64_t(x)) << 2 | spread(std::uint64_t(y)) << 1 |
                                            spread(std::uint64_t(z)));
                    if (entry == mCells.numbers.end()) continue;
                    for (std::uint32_t j = mCells.begin[entry->second]; j < mCells.begin[entry->second + 1];
                         ++j)
                        members.push_back(j);
                }
            }
    }

    // @return false if more rings would be needed
    bool byCells(std::uint32_t i, std::vector<std::uint32_t>* members, int& gathered,
                 std::vector<Near>& near) const {
        near.clear();
        const Vec3f& p = mCells.point[i];
        // Distance to the nearest face of the own cell, less what roundings may hide.
        double inside = mCells.side();
        for (int a = 0; a < 3; ++a) {
            const double low =
                double(mCells.box.low[a]) + double(mCells.box.cell(p, a) >> mCells.shift) * mCells.side();
            inside = std::min({inside, double(p[a]) - low, low + mCells.side() - double(p[a])});
        }
        for (int ring = 0; ring <= kRings; ++ring) {
            if (ring > gathered) {
                gather(i, ring, members[ring]);
                gathered = ring;
            }
            for (std::uint32_t j : members[ring]) {
                const Vec3f v = mCells.point[j] - p;
                const float squared = dot(v, v);
                if (isNeighbour(i, j, squared)) near.push_back({squared, mCells.coded[j].number});
            }
            const double safe = 0.999 * (double(ring) * mCells.side() + inside);
            if (safe <= 0 || near.size() < mCount) continue;
            std::nth_element(near.begin(), near.begin() + std::ptrdiff_t(mCount - 1), near.end());
            if (double(near[mCount - 1].squared) > safe * safe) continue;
            near.resize(mCount);
            std::sort(near.begin(), near.end());
            return true;
        }
        return false;
    }

    void byTree(std::uint32_t i, std::vector<Near>& near) const {
        const Vec3f& p = mCells.point[i];
        const std::size_t all = mCells.point.size(), most = std::min(all, 16 * mCount + 64);
        std::vector<std::uint32_t> numbers(most);
        std::vector<float> squared(most);
        for (std::size_t ask = std::min(all, 2 * mCount + 2);; ask = std::min(most, 2 * ask)) {
            const std::size_t got = mTree.nearest(p, ask, numbers.data(), squared.data());
            near.clear();
            for (std::size_t k = 0; k < got; ++k) {
                const Vec3f v = mSites.point[numbers[k]] - p;
                if (dot(v, v) > 0 && dot(mCells.normal[i], mSites.normal[numbers[k]]) > 0)
                    near.push_back({dot(v, v), numbers[k]});
            }
            if (near.size() >= mCount || ask >= most) break;
        }
        std::sort(near.begin(), near.end());
        if (near.size() > mCount) near.resize(mCount);
    }

    const SurfaceSites& mSites;
    std::size_t mCount;
    Cells mCells;
    PointNeighbours mTree;
};

// The neighbours of all sites, `count` slots each; the number found in `found`.
void findAll(const SurfaceSites& sites, std::size_t count, std::vector<std::uint32_t>& slots,
             std::vector<std::uint32_t>& found, const RunContext& ctx) {
    const Finder finder(sites, count, ctx);
    parallelFor(ctx, finder.cells(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell)
            finder.around(cell, [&](std::uint32_t i, const std::vector<Near>& near) {
                found[i] = std::uint32_t(near.size());
                for (std::size_t k = 0; k < near.size(); ++k) slots[i * count + k] = near[k].number;
            });
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
