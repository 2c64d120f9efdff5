#include "libvdbsynth/coordinates/site_tangents.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/points/site_levels.h"
#include "libvdbsynth/surface/direction_field.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr std::size_t kMerged = 20000;  // points from which on directions are found on fewer sites
constexpr double kMergedCell = 2.5;     // [spacings]

// The longest side of the points' box, which directions follow where none matters.
Vec3f longestAxis(const std::vector<Vec3f>& points) {
    Vec3f low = points[0], high = points[0];
    for (const Vec3f& p : points)
        for (int a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], p[a]);
            high[a] = std::max(high[a], p[a]);
        }
    Vec3f axis;
    int longest = 0;
    for (int a = 1; a < 3; ++a)
        if (high[a] - low[a] > high[longest] - low[longest]) longest = a;
    axis[longest] = 1;
    return axis;
}

DirectionField fieldOn(const SurfaceSites& sites, const std::vector<Vec3f>& given, double spacing,
                       const RunContext& ctx) {
    const std::vector<Index3> places = sitePlaces(sites, 1.5 * spacing);
    if (anyDirection(given)) return directionField(sites, places, given, ctx);
    return smoothDirectionField(sites, places, longestAxis(sites.point), ctx);
}

// The tangents of coarser sites, read at finer points: the mean over the parent and its neighbours, by
// distance.
std::vector<Vec3f> readBetween(const SurfaceSites& fine, const SurfaceSites& coarse,
                               const std::vector<Vec3f>& tangent, const std::vector<std::uint32_t>& parent,
                               double reach, const RunContext& ctx) {
    std::vector<Vec3f> out(fine.point.size());
    const float squaredReach = float(reach * reach);
    parallelFor(ctx, out.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = parent[i];
            Vec3f sum = tangent[p] * 1e-3f;
            const auto add = [&](std::uint32_t j) {
                const Vec3f v = fine.point[i] - coarse.point[j];
                const float share = 1 - dot(v, v) / squaredReach;
                if (share > 0) sum = sum + tangent[j] * (share * share);
            };
            add(p);
            for (std::uint32_t k = coarse.begin[p]; k < coarse.begin[p + 1]; ++k) add(coarse.neighbours[k]);
            out[i] = tangentNear(fine.normal[i], sum);
        }
    });
    return out;
}

}  // namespace

bool anyDirection(const std::vector<Vec3f>& directions) {
    return std::any_of(directions.begin(), directions.end(), [](const Vec3f& d) { return dot(d, d) > 0; });
}

std::vector<Vec3f> siteTangents(const SurfaceSites& sites, const std::vector<Vec3f>& directions,
                                double spacing, std::vector<Vec3f>* singularities, const RunContext& ctx) {
    if (sites.size() <= kMerged) {
        DirectionField field = fieldOn(sites, directions, spacing, ctx);
        if (singularities) *singularities = std::move(field.singularities);
        return std::move(field.tangent);
    }
    const double cell = kMergedCell * spacing;
    CoarserSites merged = mergedByCells(sites.point, sites.normal, cell, ctx);
    const std::vector<std::uint32_t> parent = std::move(merged.parent);
    std::vector<Vec3f> given;
    if (!directions.empty()) {
        given.assign(merged.point.size(), {});
        for (std::size_t i = 0; i < parent.size(); ++i) given[parent[i]] = given[parent[i]] + directions[i];
    }
    const SurfaceSites coarse =
        sitesOfPoints(std::move(merged.point), std::move(merged.normal), kSiteNeighbours, ctx);
    DirectionField field = fieldOn(coarse, given, cell, ctx);
    if (singularities) *singularities = std::move(field.singularities);
    return readBetween(sites, coarse, field.tangent, parent, 2 * cell, ctx);
}

}  // namespace vdbsynth
