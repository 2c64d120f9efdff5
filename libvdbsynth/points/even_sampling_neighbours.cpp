#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/even_sampling_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vdbsynth {
namespace {

constexpr double kWidest = -0.8660254037844386;  // cosine of 150 degrees

// Of the same sheet: facing the same way, and beside the place rather than above or below it, or on it but
// for what projections differ by.
bool sameSheet(const Vec3d& chord, double distance, const Vec3d& normal, const Vec3d& other, double spacing) {
    constexpr double kOnIt = 0.1;  // [spacings]
    return dot(normal, other) > 0 &&
           std::abs(dot(chord, normal + other)) <= std::max(distance, 2 * kOnIt * spacing);
}

// Grows with the angle of a direction of length 1, without a function of angles.
double turnOf(double x, double y) {
    return y >= 0 ? 1 - x : 3 + x;
}

OrientedPoints oriented(std::vector<Vec3f> points, std::vector<Vec3f> normals) {
    OrientedPoints all;
    all.point = std::move(points);
    all.normal = std::move(normals);
    return all;
}

}  // namespace

TangentFrame::TangentFrame(const Vec3d& n) {
    const Vec3d axis = std::abs(n.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    u = normalized(cross(n, axis));
    v = cross(n, u);
}

SampledPoints::SampledPoints(std::vector<Vec3f> points, std::vector<Vec3f> normals, double reach)
    : mPoints(oriented(std::move(points), std::move(normals))),
      mBlocks(mPoints, std::vector<float>(mPoints.point.size(), float(reach))) {}

void SampledPoints::around(const Vec3d& place, const Vec3d& normal, std::int64_t self,
                           std::vector<PlanarNeighbour>& neighbours) const {
    neighbours.clear();
    const TangentFrame frame(normal);
    const double reach = double(mBlocks.leastReach());
    mBlocks.forRuns(cast<float>(place), 1, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end; ++k) {
            const Vec3d chord = cast<double>(mBlocks[k].point) - place;
            const double squared = dot(chord, chord);
            if (!(squared > 0) || squared >= reach * reach || std::int64_t(mBlocks.number(k)) == self)
                continue;
            PlanarNeighbour neighbour;
            neighbour.distance = std::sqrt(squared);
            if (!sameSheet(chord, neighbour.distance, normal, cast<double>(mBlocks[k].normal), reach / 2))
                continue;
            const double x = dot(chord, frame.u), y = dot(chord, frame.v), size = std::sqrt(x * x + y * y);
            if (!(size > 0)) continue;
            neighbour.number = mBlocks.number(k);
            neighbour.x = x / size;
            neighbour.y = y / size;
            neighbour.turn = turnOf(neighbour.x, neighbour.y);
            neighbours.push_back(neighbour);
        }
    });
    std::sort(neighbours.begin(), neighbours.end(), [](const PlanarNeighbour& a, const PlanarNeighbour& b) {
        return a.turn != b.turn ? a.turn < b.turn : a.number < b.number;
    });
}

bool SampledPoints::any(const Vec3d& place, const Vec3d& normal, double distance) const {
    bool found = false;
    const float part = float(distance) / mBlocks.leastReach();
    mBlocks.forRuns(cast<float>(place), part, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t k = begin; k < end && !found; ++k) {
            const Vec3d chord = cast<double>(mBlocks[k].point) - place;
            const double far = length(chord);
            found =
                far < distance && sameSheet(chord, far, normal, cast<double>(mBlocks[k].normal), distance);
        }
    });
    return found;
}

bool isSurrounded(const std::vector<PlanarNeighbour>& neighbours) {
    if (neighbours.size() < 3) return false;
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        const PlanarNeighbour &a = neighbours[k], &b = neighbours[(k + 1) % neighbours.size()];
        if (a.x * b.y - a.y * b.x < 0 || a.x * b.x + a.y * b.y < kWidest) return false;
    }
    return true;
}

std::optional<SurfaceFoot> projectScaled(const PointSetSurface& surface, const Vec3d& place,
                                         const Vec3d& facing, double scale) {
    std::optional<SurfaceFoot> foot = surface.project(place * (1 / scale), facing);
    if (foot) foot->point = foot->point * scale;
    return foot;
}

std::vector<std::uint32_t> withoutNear(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                                       const std::vector<char>& fixed, double distance,
                                       const RunContext& ctx) {
    std::vector<std::uint32_t> kept(points.size());
    std::iota(kept.begin(), kept.end(), 0u);
    if (!(distance > 0)) return kept;
    // The near pairs of each point that is not fixed, found by all threads; who stays is decided in order.
    // In cells of two distances: smaller ones hold too few points to be worth their making.
    constexpr float kReach = 4;
    const PointBlocks blocks(oriented(points, normals),
                             std::vector<float>(points.size(), kReach * float(distance)));
    std::vector<std::vector<std::uint32_t>> near(points.size());
    const auto isFixed = [&](std::size_t i) { return !fixed.empty() && fixed[i]; };
    parallelFor(ctx, points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (isFixed(i)) continue;
            blocks.forRuns(points[i], 1 / kReach, [&](std::uint32_t first, std::uint32_t last) {
                for (std::uint32_t k = first; k < last; ++k) {
                    const std::uint32_t j = blocks.number(k);
                    const Vec3d chord = cast<double>(points[j]) - cast<double>(points[i]);
                    const double far = length(chord);
                    if (far < distance && (isFixed(j) || j < i) &&
                        sameSheet(chord, far, cast<double>(normals[i]), cast<double>(normals[j]), distance))
                        near[i].push_back(j);
                }
            });
        }
    });
    std::vector<char> stays(points.size(), 1);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::uint32_t j : near[i])
            if (stays[j]) stays[i] = 0;
    kept.erase(std::remove_if(kept.begin(), kept.end(), [&](std::uint32_t i) { return !stays[i]; }),
               kept.end());
    return kept;
}

}  // namespace vdbsynth
