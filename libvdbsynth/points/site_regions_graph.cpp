// Differences between neighbouring sites: angles of normals, convex and concave ones apart.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/points/site_regions_steps.h"

#include <algorithm>
#include <tuple>

namespace vdbsynth {
namespace {

constexpr double kConvex = 0.5;  // weight of convex creases relative to concave ones

// The angle between two sites' normals as far as the mean distance of neighbours away; convex is positive.
double bend(const SurfaceSites& sites, std::uint32_t a, std::uint32_t b, double spacing) {
    const Vec3d n = cast<double>(sites.normal[a]), m = cast<double>(sites.normal[b]);
    const Vec3d across = cast<double>(sites.point[b]) - cast<double>(sites.point[a]);
    const double angle = arcTangent(length(cross(n, m)), dot(n, m));
    const double nearer = length(across) > spacing ? spacing / length(across) : 1;
    return dot(m - n, across) >= 0 ? angle * nearer : -angle * nearer;
}

double meanDistance(const SurfaceSites& sites) {
    double sum = 0;
    for (std::uint32_t i = 0; i < sites.size(); ++i)
        for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
            sum += double(length(sites.point[sites.neighbours[k]] - sites.point[i]));
    return sites.neighbours.empty() ? 1 : sum / double(sites.neighbours.size());
}

void measureSites(RegionGraph& graph, double spacing, const RunContext& ctx) {
    const SurfaceSites& sites = graph.sites;
    graph.area.assign(sites.size(), spacing * spacing);
    graph.curvature.assign(sites.size(), 0);
    parallelFor(ctx, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const double degree = double(sites.degree(i));
            if (degree == 0) continue;
            double distance = 0, curvature = 0;
            for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k) {
                distance += double(length(sites.point[sites.neighbours[k]] - sites.point[i]));
                curvature += bend(sites, std::uint32_t(i), sites.neighbours[k], spacing);
            }
            graph.area[i] = distance / degree * (distance / degree);
            graph.curvature[i] = curvature / degree;
        }
    });
}

std::vector<RegionEdge> edgesOf(const SurfaceSites& sites, const RunContext& ctx) {
    std::vector<RegionEdge> edges;
    for (std::uint32_t i = 0; i < sites.size(); ++i)
        for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
            edges.push_back({std::min(i, sites.neighbours[k]), std::max(i, sites.neighbours[k]), 0});
    const auto numbers = [](const RegionEdge& e) { return std::make_tuple(e.a, e.b); };
    parallelSort(ctx, edges,
                 [&](const RegionEdge& e, const RegionEdge& f) { return numbers(e) < numbers(f); });
    edges.erase(
        std::unique(edges.begin(), edges.end(),
                    [&](const RegionEdge& e, const RegionEdge& f) { return numbers(e) == numbers(f); }),
        edges.end());
    return edges;
}

}  // namespace

RegionGraph regionGraph(const SurfaceSites& sites, const RunContext& ctx) {
    RegionGraph graph{sites, edgesOf(sites, ctx), {}, {}};
    const double spacing = meanDistance(sites);
    measureSites(graph, spacing, ctx);
    parallelFor(ctx, graph.edges.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            RegionEdge& edge = graph.edges[k];
            const double by = bend(sites, edge.a, edge.b, spacing);
            edge.difference = float(by >= 0 ? kConvex * by : -by);
        }
    });
    const auto order = [](const RegionEdge& e) { return std::make_tuple(e.difference, e.a, e.b); };
    parallelSort(ctx, graph.edges,
                 [&](const RegionEdge& e, const RegionEdge& f) { return order(e) < order(f); });
    return graph;
}

}  // namespace vdbsynth
