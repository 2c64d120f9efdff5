#include "libvdbsynth/patch/onto/onto_surface.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/coordinates/site_tangents.h"

#include <algorithm>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::size_t kNeighbours = 8;

// Of two sites of which one counts the other among its nearest, each is the other's neighbour.
SurfaceSites bothWays(const SurfaceSites& sites) {
    std::vector<std::vector<std::uint32_t>> lists(sites.size());
    for (std::uint32_t from = 0; from < sites.size(); ++from)
        for (std::size_t n = sites.begin[from]; n < sites.begin[from + 1]; ++n) {
            lists[from].push_back(sites.neighbours[n]);
            lists[sites.neighbours[n]].push_back(from);
        }
    SurfaceSites both{sites.point, sites.normal, {0}, {}};
    for (auto& list : lists) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        both.neighbours.insert(both.neighbours.end(), list.begin(), list.end());
        both.begin.push_back(std::uint32_t(both.neighbours.size()));
    }
    return both;
}

}  // namespace

OntoSurface ontoSurface(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                        const std::vector<Vec3f>& directions, double spacing, const RunContext& ctx) {
    if (points.empty()) throw Error(ErrorCode::EmptyInput, "the model has no surface to lay patches over");
    if (!(spacing > 0)) throw Error(ErrorCode::InvalidOption, "the spacing of sites must be above 0");
    if (!directions.empty() && directions.size() != points.size())
        throw Error(ErrorCode::ShapeMismatch, "sites and directions differ in number");
    const SurfaceSites nearest = sitesOfPoints(std::move(points), std::move(normals), kNeighbours, ctx);
    OntoSurface surface;
    std::vector<Vec3f> singular;
    surface.tangent = siteTangents(nearest, directions, spacing, &singular, ctx);
    for (const Vec3f& place : singular) surface.singularities.push_back(cast<double>(place));
    surface.sites = bothWays(nearest);
    return surface;
}

OntoSurface ontoSurfaceAlong(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                             std::vector<Vec3f> tangents, const RunContext& ctx) {
    if (points.empty()) throw Error(ErrorCode::EmptyInput, "the model has no surface to lay patches over");
    if (tangents.size() != points.size())
        throw Error(ErrorCode::ShapeMismatch, "sites and directions differ in number");
    OntoSurface surface;
    surface.sites = bothWays(sitesOfPoints(std::move(points), std::move(normals), kNeighbours, ctx));
    surface.tangent = std::move(tangents);
    return surface;
}

}  // namespace vdbsynth
