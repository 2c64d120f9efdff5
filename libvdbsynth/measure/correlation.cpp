#include "libvdbsynth/measure/correlation.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/math/vec3.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vdbsynth {
namespace {

constexpr std::size_t kDirections = 48;

bool inShell(const Index3& p, int r) {
    return std::lround(std::sqrt(double(p.x) * p.x + double(p.y) * p.y + double(p.z) * p.z)) == r;
}

// The one of p and -p that represents both.
bool upper(const Index3& p) {
    return p.z > 0 || (p.z == 0 && (p.y > 0 || (p.y == 0 && p.x >= 0)));
}

// The lattice point of the shell nearest to p, a point of length r: simple rounding can leave the shell by
// less than a step.
Index3 nearestInShell(int r, const Vec3d& p) {
    Index3 nearest;
    double best = -1;
    const Index3 rounded{int(std::lround(p.x)), int(std::lround(p.y)), int(std::lround(p.z))};
    forEachVoxel(IndexBox{rounded, rounded}.expanded(1), [&](const Index3& q) {
        if (!inShell(q, r)) return;
        const Vec3d d = p - Vec3d{double(q.x), double(q.y), double(q.z)};
        if (best < 0 || dot(d, d) < best) {
            nearest = q;
            best = dot(d, d);
        }
    });
    return upper(nearest) ? nearest : nearest * -1;
}

}  // namespace

std::vector<Index3> radialShifts(int r) {
    // From this radius on there are far more.
    constexpr int kCrowded = 5;
    std::vector<Index3> all;
    if (r < kCrowded)
        forEachVoxel({{-r, -r, 0}, {r, r, r}}, [&](const Index3& p) {
            if (upper(p) && inShell(p, r)) all.push_back(p);
        });
    if (r < kCrowded && all.size() <= kDirections) return all;
    // A Fibonacci spiral on the half sphere; each point maps to its nearest lattice
    // point, which may be shared.
    std::set<Index3> chosen;
    const double golden = kPi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < kDirections; ++i) {
        const double z = (double(i) + 0.5) / double(kDirections), flat = std::sqrt(1 - z * z);
        const double turn = golden * double(i);
        chosen.insert(nearestInShell(r, {r * flat * cosine(turn), r * flat * sine(turn), r * z}));
    }
    return {chosen.begin(), chosen.end()};
}

namespace {

double pairsWithin(const Index3& size, const Index3& shift) {
    double pairs = 1;
    for (int axis = 0; axis < 3; ++axis) pairs *= std::max(0, size[axis] - std::abs(shift[axis]));
    return pairs;
}

// The lengths of the solid runs of a line, with whether they touch its ends.
template <typename Visit>
void visitRuns(const std::vector<char>& line, const Visit& visit) {
    const int n = int(line.size());
    for (int i = 0; i < n;) {
        if (!line[std::size_t(i)]) {
            ++i;
            continue;
        }
        int end = i;
        while (end < n && line[std::size_t(end)]) ++end;
        visit(i, end);
        i = end;
    }
}

}  // namespace

TwoPointCorrelation twoPointCorrelation(const Occupancy& solid, int reach, const RunContext& ctx) {
    struct Task {
        Index3 shift;
        int r;
        int axis;  // -1: radial
        std::uint64_t hits = 0;
    };
    std::vector<Task> tasks;
    for (int r = 0; r <= reach; ++r) {
        for (const Index3& shift : radialShifts(r)) tasks.push_back({shift, r, -1});
        for (int axis = 0; axis < 3; ++axis) {
            Index3 shift{0, 0, 0};
            shift[axis] = r;
            tasks.push_back({shift, r, axis});
        }
    }
    parallelFor(ctx, tasks.size(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) tasks[i].hits = countPairs(solid, solid, tasks[i].shift);
    });
    TwoPointCorrelation result;
    result.radial.assign(std::size_t(reach) + 1, 0);
    std::vector<double> pairs(std::size_t(reach) + 1, 0);
    for (std::vector<double>& curve : result.axis) curve.assign(std::size_t(reach) + 1, 0);
    for (const Task& task : tasks) {
        const double within = pairsWithin(solid.size(), task.shift);
        if (task.axis >= 0) {
            result.axis[std::size_t(task.axis)][std::size_t(task.r)] =
                double(task.hits) / std::max(1.0, within);
        } else {
            result.radial[std::size_t(task.r)] += double(task.hits);
            pairs[std::size_t(task.r)] += within;
        }
    }
    for (std::size_t r = 0; r < pairs.size(); ++r) result.radial[r] /= std::max(1.0, pairs[r]);
    return result;
}

LineStatistics lineStatistics(const Occupancy& solid, int axis, int reach) {
    const Index3& size = solid.size();
    const int n = size[axis], u = (axis + 1) % 3, v = (axis + 2) % 3;
    LineStatistics result;
    std::vector<double> placements(std::size_t(reach) + 1, 0), chords(std::size_t(reach) + 1, 0);
    std::vector<char> line(static_cast<std::size_t>(n));
    double voxels = 0, beginnings = 0, whole = 0;
    for (int a = 0; a < size[u]; ++a)
        for (int b = 0; b < size[v]; ++b) {
            Index3 p;
            p[u] = a;
            p[v] = b;
            for (int i = 0; i < n; ++i) {
                p[axis] = i;
                line[std::size_t(i)] = solid.at(p.x, p.y, p.z);
            }
            visitRuns(line, [&](int begin, int end) {
                const int length = end - begin;
                for (int r = 0; r < std::min(length, reach + 1); ++r)
                    placements[std::size_t(r)] += length - r;
                voxels += length;
                // Changes from void to solid and from solid to void, half a chord each.
                beginnings += (begin > 0 ? 0.5 : 0) + (end < n ? 0.5 : 0);
                if (begin > 0 && end < n) {
                    // Of its positions in an endless line, n - 1 - length contain it whole.
                    const double weight = 1.0 / (n - 1 - length);
                    chords[std::size_t(std::min(length, reach))] += weight;
                    whole += weight;
                }
            });
        }
    const double lines = double(size[u]) * size[v];
    result.linealPath.resize(placements.size());
    for (std::size_t r = 0; r < placements.size(); ++r)
        result.linealPath[r] = int(r) < n ? placements[r] / (lines * (n - double(r))) : 0;
    result.chords = chords;
    if (whole > 0)
        for (double& share : result.chords) share /= whole;
    // Changes are observed between n - 1 pairs of n voxels.
    if (beginnings > 0) result.meanChord = voxels / n / (beginnings / std::max(1, n - 1));
    return result;
}

}  // namespace vdbsynth
