// Follows [felzenszwalb2004] for the first regions, on a graph of sites in place of pixels.
#include "libvdbsynth/points/site_regions.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/points/site_regions_steps.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace vdbsynth {
namespace {

constexpr std::size_t kNeighbours = 8, kMostRegions = 4096;
constexpr double kScale = 0.1;         // k of [felzenszwalb2004], radians times sites
constexpr double kIslandShare = 0.01;  // of the largest piece's area

std::vector<std::uint32_t> rootsOf(DisjointSets& sets, std::size_t count) {
    std::vector<std::uint32_t> roots(count);
    for (std::uint32_t i = 0; i < count; ++i) roots[i] = sets.root(i);
    return roots;
}

std::vector<std::uint32_t> firstRegions(const RegionGraph& graph) {
    const std::size_t count = graph.sites.size();
    DisjointSets sets(count);
    std::vector<double> inside(count, 0), size(count, 1);
    for (const RegionEdge& edge : graph.edges) {
        const std::uint32_t a = sets.root(edge.a), b = sets.root(edge.b);
        if (a == b) continue;
        const double difference = double(edge.difference);
        if (difference > std::min(inside[a] + kScale / size[a], inside[b] + kScale / size[b])) continue;
        sets.join(a, b);
        const std::uint32_t root = std::min(a, b);
        inside[root] = difference;  // edges come in its order
        size[root] = size[a] + size[b];
    }
    return rootsOf(sets, count);
}

// [sites] the piece of each that is too small to be a region of its own.
std::vector<char> islandsOf(const RegionGraph& graph) {
    DisjointSets sets(graph.sites.size());
    for (const RegionEdge& edge : graph.edges) sets.join(edge.a, edge.b);
    const std::vector<std::uint32_t> piece = rootsOf(sets, graph.sites.size());
    std::vector<double> area(piece.size(), 0);
    for (std::size_t i = 0; i < piece.size(); ++i) area[piece[i]] += graph.area[i];
    const double least = kIslandShare * *std::max_element(area.begin(), area.end());
    std::vector<char> island(piece.size(), 0);
    for (std::size_t i = 0; i < piece.size(); ++i) island[i] = area[piece[i]] < least;
    return island;
}

// The graph without islands, and the sites that it kept.
SurfaceSites mainland(const SurfaceSites& sites, const std::vector<char>& island,
                      std::vector<std::uint32_t>& kept) {
    std::vector<std::uint32_t> number(sites.size(), 0);
    SurfaceSites out;
    for (std::uint32_t i = 0; i < sites.size(); ++i) {
        if (island[i]) continue;
        number[i] = std::uint32_t(kept.size());
        kept.push_back(i);
        out.point.push_back(sites.point[i]);
        out.normal.push_back(sites.normal[i]);
    }
    out.begin.push_back(0);
    for (std::uint32_t i : kept) {
        for (std::uint32_t k = sites.begin[i]; k < sites.begin[i + 1]; ++k)
            out.neighbours.push_back(number[sites.neighbours[k]]);
        out.begin.push_back(std::uint32_t(out.neighbours.size()));
    }
    return out;
}

struct Area {
    std::uint32_t region;
    double area;
};

// The largest first; equal ones by number.
std::vector<Area> byArea(const std::vector<std::uint32_t>& region, const std::vector<double>& area) {
    std::map<std::uint32_t, double> sums;
    for (std::size_t i = 0; i < region.size(); ++i) sums[region[i]] += area[i];
    std::vector<Area> sorted;
    for (const auto& [number, sum] : sums) sorted.push_back({number, sum});
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Area& a, const Area& b) { return a.area > b.area; });
    return sorted;
}

// Regions of similar area become one, so that `count` remain.
void groupRegions(const std::vector<double>& area, std::size_t count, std::vector<std::uint32_t>& region) {
    const std::vector<Area> sorted = byArea(region, area);
    if (sorted.size() <= count) return;
    std::vector<std::size_t> cuts(sorted.size() - 1);  // k is between k and k + 1
    std::iota(cuts.begin(), cuts.end(), std::size_t(0));
    std::stable_sort(cuts.begin(), cuts.end(), [&](std::size_t k, std::size_t l) {
        return sorted[k].area * sorted[l + 1].area > sorted[l].area * sorted[k + 1].area;
    });
    std::vector<char> cut(sorted.size(), 0);
    for (std::size_t k = 0; k + 1 < count; ++k) cut[cuts[k] + 1] = 1;
    std::map<std::uint32_t, std::uint32_t> group;
    std::uint32_t first = 0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        if (k == 0 || cut[k]) first = sorted[k].region;
        group[sorted[k].region] = first;
    }
    for (std::uint32_t& r : region) r = group[r];
}

std::vector<std::int32_t> labelsOf(const std::vector<std::uint32_t>& region,
                                   const std::vector<Area>& sorted) {
    std::map<std::uint32_t, std::int32_t> number;
    for (const Area& one : sorted) number[one.region] = std::int32_t(number.size());
    std::vector<std::int32_t> label;
    for (std::uint32_t r : region) label.push_back(number[r]);
    return label;
}

SiteRegions regionsOf(const RegionGraph& graph, std::size_t count, const RunContext& ctx) {
    SiteRegions out;
    std::vector<std::uint32_t> region = firstRegions(graph);
    mergeRegions(graph, count, region, ctx);
    out.found = byArea(region, graph.area).size();
    out.halved = halveRegions(graph, count, region, ctx);
    groupRegions(graph.area, count, region);
    const std::vector<Area> sorted = byArea(region, graph.area);
    out.labels = sorted.size();
    out.label = labelsOf(region, sorted);
    return out;
}

// Islands take the label of the nearest site of the rest.
void spread(SiteRegions& regions, const SurfaceSites& sites, const SurfaceSites& rest,
            const std::vector<std::uint32_t>& kept, const RunContext& ctx) {
    const PointNeighbours neighbours(rest.point);
    std::vector<std::int32_t> label(sites.size(), -1);
    for (std::size_t k = 0; k < kept.size(); ++k) label[kept[k]] = regions.label[k];
    parallelFor(ctx, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            std::uint32_t nearest = 0;
            float squared = 0;
            if (label[i] >= 0) continue;
            neighbours.nearest(sites.point[i], 1, &nearest, &squared);
            label[i] = regions.label[nearest];
        }
    });
    regions.islands = sites.size() - kept.size();
    regions.label = std::move(label);
}

}  // namespace

SurfaceSites sitesAcrossCreases(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                                const RunContext& ctx) {
    std::vector<Vec3f> oneWay(points.size(), Vec3f{0, 0, 1});
    SurfaceSites sites = sitesOfPoints(std::move(points), std::move(oneWay), kNeighbours, ctx);
    sites.normal = std::move(normals);
    return sites;
}

SiteRegions siteRegions(const SurfaceSites& sites, std::size_t count, const RunContext& ctx) {
    requireOption(count >= 1 && count <= kMostRegions, "count", std::to_string(count),
                  "a whole number from 1 to 4096");
    if (sites.size() == 0) throw Error(ErrorCode::EmptyInput, "there are no sites to divide into regions");
    return withThreads(ctx, [&] {
        const RegionGraph graph = regionGraph(sites, ctx);
        const std::vector<char> island = islandsOf(graph);
        if (std::count(island.begin(), island.end(), char(1)) == 0) return regionsOf(graph, count, ctx);
        std::vector<std::uint32_t> kept;
        const SurfaceSites rest = mainland(sites, island, kept);
        SiteRegions regions = regionsOf(regionGraph(rest, ctx), count, ctx);
        spread(regions, sites, rest, kept, ctx);
        return regions;
    });
}

}  // namespace vdbsynth
