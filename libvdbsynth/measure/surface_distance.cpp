#include "libvdbsynth/measure/surface_distance.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/geometry/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::size_t kVertices = 8;

// The faces around each vertex, and a third of their area.
struct Around {
    std::vector<std::uint32_t> first, faces;
    std::vector<double> area;
};

Around facesAround(const Mesh& mesh, const std::vector<Triangle>& faces) {
    Around around;
    around.first.assign(mesh.points.size() + 1, 0);
    around.area.assign(mesh.points.size(), 0);
    for (const Triangle& t : faces)
        for (std::uint32_t v : t) ++around.first[v + 1];
    for (std::size_t v = 0; v < mesh.points.size(); ++v) around.first[v + 1] += around.first[v];
    around.faces.resize(faces.size() * 3);
    std::vector<std::uint32_t> next(around.first.begin(), around.first.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const Triangle& t = faces[f];
        const Vec3d a = cast<double>(mesh.points[t[0]]), b = cast<double>(mesh.points[t[1]]),
                    c = cast<double>(mesh.points[t[2]]);
        const double share = length(cross(b - a, c - a)) / 6;
        for (std::uint32_t v : t) {
            around.faces[next[v]++] = std::uint32_t(f);
            around.area[v] += share;
        }
    }
    return around;
}

bool counts(const Vec3f& p, const std::optional<IndexBox>& within) {
    for (int axis = 0; within && axis < 3; ++axis)
        if (p[axis] < float(within->min[axis]) || p[axis] > float(within->max[axis])) return false;
    return true;
}

SurfaceDistance oneWay(const Mesh& from, const Mesh& to, const std::optional<IndexBox>& within,
                       const RunContext& ctx) {
    const std::vector<Triangle> faces = triangulated(to);
    const Around around = facesAround(to, faces), own = facesAround(from, triangulated(from));
    const PointNeighbours neighbours(to.points);
    std::vector<double> distances(from.points.size(), 0);
    parallelFor(ctx, from.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        std::uint32_t numbers[kVertices];
        float squared[kVertices];
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d p = cast<double>(from.points[i]);
            const std::size_t found = neighbours.nearest(from.points[i], kVertices, numbers, squared);
            double best = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < found; ++k)
                for (std::uint32_t f = around.first[numbers[k]]; f < around.first[numbers[k] + 1]; ++f) {
                    const Triangle& t = faces[around.faces[f]];
                    const Vec3d a = cast<double>(to.points[t[0]]), b = cast<double>(to.points[t[1]]),
                                c = cast<double>(to.points[t[2]]);
                    const Vec3d w = nearestInTriangle(p, a, b, c);
                    const Vec3d nearest = a * w.x + b * w.y + c * w.z;
                    best = std::min(best, dot(p - nearest, p - nearest));
                }
            distances[i] = std::isfinite(best) ? std::sqrt(best) : 0;
        }
    });
    SurfaceDistance result;
    double area = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        // A vertex without faces is not on the surface.
        if (own.area[i] <= 0 || !counts(from.points[i], within)) continue;
        area += own.area[i];
        result.mean += own.area[i] * distances[i];
        result.rootMean += own.area[i] * distances[i] * distances[i];
        result.hausdorff = std::max(result.hausdorff, distances[i]);
    }
    if (area <= 0) return {};
    result.mean /= area;
    result.rootMean = std::sqrt(result.rootMean / area);
    return result;
}

}  // namespace

SurfaceDistance surfaceDistance(const Mesh& a, const Mesh& b, const std::optional<IndexBox>& within,
                                const RunContext& ctx) {
    const SurfaceDistance there = oneWay(a, b, within, ctx), back = oneWay(b, a, within, ctx);
    return {std::max(there.mean, back.mean), std::max(there.rootMean, back.rootMean),
            std::max(there.hausdorff, back.hausdorff)};
}

}  // namespace vdbsynth
