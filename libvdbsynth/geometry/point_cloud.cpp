#include "libvdbsynth/geometry/point_cloud.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/disjoint_sets.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>

namespace vdbsynth {
namespace {

constexpr std::size_t kPlane = 16;  // neighbours that define a plane

// Keeps the points where `keep` is set.
void keepOnly(PointCloud& cloud, const std::vector<char>& keep) {
    std::size_t kept = 0;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < keep.size(); ++i) {
        if (!keep[i]) continue;
        rows.push_back(i);
        cloud.points[kept] = cloud.points[i];
        if (!cloud.normals.empty()) cloud.normals[kept] = cloud.normals[i];
        ++kept;
    }
    if (kept < keep.size()) cloud.attributes = selectRows(cloud.attributes, rows);
    cloud.points.resize(kept);
    if (!cloud.normals.empty()) cloud.normals.resize(kept);
}

void dropRepeats(PointCloud& cloud) {
    std::vector<std::uint32_t> order(cloud.points.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Vec3f& p = cloud.points[i];
        return std::make_tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    std::vector<char> keep(cloud.points.size(), 1);
    for (std::size_t i = 1; i < order.size(); ++i) keep[order[i]] = key(order[i]) != key(order[i - 1]);
    keepOnly(cloud, keep);
}

// A point this many spreads from the others' centre leaves them no digits in floats of their common box.
constexpr double kAstray = 1e6;

// Removes points that are so far out that distances to them mean nothing.
void dropAstray(PointCloud& cloud) {
    const PointCore core = coreOf(cloud.points);
    if (!(core.spread > 0)) return;
    std::vector<char> keep(cloud.points.size());
    for (std::size_t i = 0; i < keep.size(); ++i)
        keep[i] = distanceFrom(core, cast<double>(cloud.points[i])) <= kAstray * core.spread;
    if (std::count(keep.begin(), keep.end(), 0) > 0) keepOnly(cloud, keep);
}

// The power of two that brings points so large or small that their squares leave the range of floats to about
// 1; 1 for all others.
double unitScale(const PointCloud& cloud) {
    const double spread = coreOf(cloud.points).spread;
    return spread > 0 && (spread < 1e-12 || spread > 1e9) ? std::ldexp(1.0, -std::ilogb(spread)) : 1;
}

PointCloud atUnitScale(const PointCloud& cloud) {
    PointCloud scaled;
    const double scale = unitScale(cloud);
    scaled.points.reserve(cloud.points.size());
    for (const Vec3f& p : cloud.points) scaled.points.push_back(cast<float>(cast<double>(p) * scale));
    return scaled;
}

// A point in the cell of a lattice.
struct PointCell {
    std::int64_t x, y, z;
    std::uint32_t point;

    auto place() const { return std::tie(x, y, z); }
    bool operator<(const PointCell& other) const {
        return place() != other.place() ? place() < other.place() : point < other.point;
    }
};

std::vector<PointCell> cellsOf(const std::vector<Vec3f>& points, double side) {
    std::vector<PointCell> cells(points.size());
    const auto along = [side](float x) { return std::int64_t(std::floor(double(x) / side)); };
    for (std::size_t i = 0; i < points.size(); ++i)
        cells[i] = {along(points[i].x), along(points[i].y), along(points[i].z), std::uint32_t(i)};
    std::sort(cells.begin(), cells.end());
    return cells;
}

// Sets of the first elements of cells: those of cells that touch are one group.
DisjointSets joinedCells(const std::vector<PointCell>& cells) {
    DisjointSets groups(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const PointCell& cell = cells[i];
        if (i > 0 && cells[i - 1].place() == cell.place()) {
            groups.join(std::uint32_t(i - 1), std::uint32_t(i));
            continue;
        }
        // A column of the neighbours that come later lies together in the order of the cells.
        for (const auto& [dx, dy] : {std::pair{0, 0}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}) {
            auto other = std::lower_bound(cells.begin(), cells.end(),
                                          PointCell{cell.x + dx, cell.y + dy, cell.z - 1, 0});
            for (; other != cells.end() && other->x == cell.x + dx && other->y == cell.y + dy &&
                   other->z <= cell.z + 1;
                 ++other)
                groups.join(std::uint32_t(i), std::uint32_t(other - cells.begin()));
        }
    }
    return groups;
}

// Unmarks the points of small groups that empty cells separate from all others.
void unmarkSmallGroups(const std::vector<Vec3f>& points, double side, std::vector<char>& keep,
                       Outliers& outliers) {
    constexpr std::size_t kMost = 100;   // points of a small group,
    constexpr std::size_t kShare = 100;  // and how many times as many the largest has at least
    const std::vector<PointCell> cells = cellsOf(points, side);
    DisjointSets groups = joinedCells(cells);
    std::vector<std::size_t> sizes(cells.size(), 0);
    for (std::size_t i = 0; i < cells.size(); ++i) ++sizes[groups.root(std::uint32_t(i))];
    const std::size_t largest = *std::max_element(sizes.begin(), sizes.end());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t size = sizes[groups.root(std::uint32_t(i))];
        if (size >= kMost || size * kShare >= largest) continue;
        if (size > 1) ++outliers.grouped;
        if (size > 1 && groups.root(std::uint32_t(i)) == i) ++outliers.groups;
        keep[cells[i].point] = 0;
    }
}

// The kPlane nearest points of each, itself included; short rows end with the point itself.
std::vector<std::uint32_t> neighbourTable(const PointCloud& cloud, const RunContext& ctx) {
    const PointNeighbours tree(cloud.points);
    std::vector<std::uint32_t> table(cloud.points.size() * kPlane);
    parallelFor(ctx, cloud.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        float squared[kPlane];
        for (std::size_t i = begin; i < end; ++i) {
            std::uint32_t* row = &table[i * kPlane];
            std::fill(row, row + kPlane, std::uint32_t(i));
            tree.nearest(cloud.points[i], kPlane, row, squared);
        }
    });
    return table;
}

// The direction in which the points of a row vary least.
Vec3f planeNormal(const PointCloud& cloud, const std::uint32_t* row) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    const auto place = [&](std::size_t k) {
        const Vec3f& p = cloud.points[row[k]];
        return Eigen::Vector3d(double(p.x), double(p.y), double(p.z));
    };
    for (std::size_t k = 0; k < kPlane; ++k) mean += place(k) / double(kPlane);
    for (std::size_t k = 0; k < kPlane; ++k) spread += (place(k) - mean) * (place(k) - mean).transpose();
    const Eigen::Vector3d normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
    const Vec3f result{float(normal.x()), float(normal.y()), float(normal.z())};
    return std::isfinite(result.x + result.y + result.z) && length(result) > 0.5f ? normalized(result)
                                                                                  : Vec3f{0, 0, 1};
}

// The neighbour graph in both directions, as one array with the start of each point's range.
struct Graph {
    std::vector<std::size_t> begin;
    std::vector<std::uint32_t> other;
};

Graph graphOf(const std::vector<std::uint32_t>& table, std::size_t points) {
    Graph graph;
    graph.begin.assign(points + 1, 0);
    const auto forPairs = [&](auto&& visit) {
        for (std::size_t i = 0; i < points; ++i)
            for (std::size_t k = 0; k < kPlane; ++k) {
                const std::uint32_t j = table[i * kPlane + k];
                if (j == i) continue;
                visit(std::uint32_t(i), j);
                visit(j, std::uint32_t(i));
            }
    };
    forPairs([&](std::uint32_t i, std::uint32_t) { ++graph.begin[i + 1]; });
    std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
    graph.other.resize(graph.begin.back());
    std::vector<std::size_t> next(graph.begin.begin(), graph.begin.end() - 1);
    forPairs([&](std::uint32_t i, std::uint32_t j) { graph.other[next[i]++] = j; });
    return graph;
}

void orientNormals(PointCloud& cloud, const Graph& graph, const RunContext& ctx) {
    using Step = std::tuple<float, std::uint32_t, std::uint32_t>;  // angle, point, from
    std::vector<std::uint32_t> order(cloud.points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return cloud.points[a].z != cloud.points[b].z ? cloud.points[a].z > cloud.points[b].z : a < b;
    });
    std::vector<char> done(cloud.points.size(), 0);
    for (std::uint32_t seed : order) {
        if (done[seed]) continue;
        throwIfCancelled(ctx);
        if (cloud.normals[seed].z < 0) cloud.normals[seed] = -cloud.normals[seed];
        std::priority_queue<Step, std::vector<Step>, std::greater<Step>> queue;
        queue.emplace(0.f, seed, seed);
        while (!queue.empty()) {
            const auto [angle, point, from] = queue.top();
            queue.pop();
            if (done[point]) continue;
            done[point] = 1;
            if (dot(cloud.normals[point], cloud.normals[from]) < 0)
                cloud.normals[point] = -cloud.normals[point];
            for (std::size_t e = graph.begin[point]; e < graph.begin[point + 1]; ++e) {
                const std::uint32_t other = graph.other[e];
                if (!done[other])
                    queue.emplace(1 - std::abs(dot(cloud.normals[point], cloud.normals[other])), other,
                                  point);
            }
        }
    }
}

}  // namespace

std::vector<float> pointSpacing(const PointCloud& cloud, const RunContext& ctx) {
    constexpr std::size_t kNearest = 7;  // itself and six
    const PointNeighbours tree(cloud.points);
    const std::size_t wanted = std::min(kNearest, cloud.points.size());
    std::vector<float> spacing(cloud.points.size(), 0);
    parallelFor(ctx, cloud.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::uint32_t numbers[kNearest];
        float squared[kNearest];
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t found = tree.nearest(cloud.points[i], kNearest, numbers, squared);
            float sum = 0;
            for (std::size_t k = 0; k < found; ++k) sum += squared[k];
            spacing[i] = found > 1 ? std::sqrt(sum / float(found - 1) / 2) : 0;
            // The tree finds no neighbour whose squared distance exceeds floats.
            if (found < wanted) spacing[i] = std::numeric_limits<float>::infinity();
        }
    });
    return spacing;
}

Outliers dropOutliers(PointCloud& cloud, const RunContext& ctx) {
    constexpr double kGap = 8;  // median spacings
    Outliers outliers;
    dropRepeats(cloud);
    if (cloud.points.size() < 8) return outliers;
    const std::size_t before = cloud.points.size();
    dropAstray(cloud);
    const double scale = unitScale(cloud);
    const std::vector<float> spacing =
        scale == 1 ? pointSpacing(cloud, ctx) : pointSpacing(atUnitScale(cloud), ctx);
    std::vector<float> sorted = spacing;
    const auto median = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
    std::nth_element(sorted.begin(), median, sorted.end());
    std::vector<char> keep(spacing.size());
    for (std::size_t i = 0; i < spacing.size(); ++i) keep[i] = spacing[i] <= float(kGap) * *median;
    keepOnly(cloud, keep);
    const double side = kGap * double(*median) / scale;
    if (side > 0 && std::isfinite(side) && !cloud.points.empty()) {
        keep.assign(cloud.points.size(), 1);
        unmarkSmallGroups(cloud.points, side, keep, outliers);
        keepOnly(cloud, keep);
    }
    outliers.points = before - cloud.points.size();
    return outliers;
}

void estimateNormals(PointCloud& cloud, const RunContext& ctx) {
    const std::vector<std::uint32_t> table =
        unitScale(cloud) == 1 ? neighbourTable(cloud, ctx) : neighbourTable(atUnitScale(cloud), ctx);
    cloud.normals.assign(cloud.points.size(), Vec3f{});
    parallelFor(ctx, cloud.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) cloud.normals[i] = planeNormal(cloud, &table[i * kPlane]);
    });
    orientNormals(cloud, graphOf(table, cloud.points.size()), ctx);
}

}  // namespace vdbsynth
