#include "libvdbsynth/relief/relief_statistics.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/relief/relief_statistics_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

struct Site {
    double weight = 0;
    ReliefPoint point;
};

// A third of the area of the faces around each vertex.
std::vector<double> areasOf(const Mesh& mesh) {
    std::vector<double> areas(mesh.points.size(), 0.0);
    for (const Triangle& face : triangulated(mesh)) {
        const Vec3d a = cast<double>(mesh.points[face[0]]), b = cast<double>(mesh.points[face[1]]),
                    c = cast<double>(mesh.points[face[2]]);
        const double third = length(cross(b - a, c - a)) / 6;
        for (const std::uint32_t corner : face) areas[corner] += third;
    }
    return areas;
}

bool contains(const IndexBox& box, const Vec3f& p) {
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < float(box.min[axis]) - 0.5f || p[axis] >= float(box.max[axis]) + 0.5f) return false;
    return true;
}

// One cell beyond the box, so that vertices at its border have all of their faces.
std::vector<Site> sitesIn(const BaseSurface& base, const IndexBox& box, const RunContext& ctx) {
    const Mesh mesh = zeroLevel(base.distance, box.expanded(1), Facing::Outward, ctx);
    std::vector<Site> sites(mesh.points.size());
    const std::vector<double> areas = areasOf(mesh);
    parallelFor(ctx, sites.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f& at = mesh.points[i];
            if (!contains(box, at)) continue;
            sites[i] = {areas[i], reliefAt(base, at, normalized(sampleGradient(base.distance, at)))};
        }
    });
    return sites;
}

void addMoments(const std::vector<Site>& sites, double measured, ReliefStatistics& statistics) {
    double sums[5] = {};
    for (const Site& site : sites) {
        if (site.weight == 0 || site.point.lost) continue;
        const double h = double(site.point.height) - statistics.mean, weight = site.weight / measured;
        sums[1] += weight * std::abs(h);
        sums[2] += weight * h * h;
        sums[3] += weight * h * h * h;
        sums[4] += weight * h * h * h * h;
    }
    statistics.sa = sums[1];
    statistics.sq = std::sqrt(sums[2]);
    if (statistics.sq < 1e-6) return;
    statistics.ssk = sums[3] / (sums[2] * statistics.sq);
    statistics.sku = sums[4] / (sums[2] * sums[2]);
}

}  // namespace

ReliefStatistics reliefStatistics(const BaseSurface& base, const IndexBox& box, const RunContext& ctx,
                                  const ReliefLayer* known) {
    const IndexBox region = box.empty() ? base.distance.box() : box;
    const std::vector<Site> sites = sitesIn(base, region, ctx);
    ReliefStatistics statistics;
    double measured = 0, sum = 0;
    for (const Site& site : sites) {
        if (site.weight == 0) continue;
        statistics.area += site.weight;
        if (site.point.folds) statistics.folded += site.weight;
        if (site.point.lost) {
            statistics.lost += site.weight;
            continue;
        }
        const double h = double(site.point.height);
        statistics.lowest = measured == 0 ? h : std::min(statistics.lowest, h);
        statistics.highest = measured == 0 ? h : std::max(statistics.highest, h);
        measured += site.weight;
        sum += site.weight * h;
    }
    if (statistics.area == 0) throw Error(ErrorCode::EmptyInput, "no base in the box to measure");
    statistics.folded /= statistics.area;
    statistics.lost /= statistics.area;
    if (measured == 0) return statistics;
    statistics.mean = sum / measured;
    addMoments(sites, measured, statistics);
    statistics.octaves = reliefOctaves(base, region, known, ctx);
    return statistics;
}

}  // namespace vdbsynth
