#include "libvdbsynth/surface/direction_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/points/site_levels.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdbsynth {
namespace {

constexpr float kTooSteep = 0.17f;  // sine of 10 degrees
constexpr float kTrusted = 0.82f;   // sine of 55 degrees
constexpr float kSingular = 0.7f;   // length of the mean direction
constexpr int kRounds = 40;         // of averaging, at every resolution

Vec3f inTangentPlane(const Vec3f& direction, const Vec3f& normal) {
    return direction - normal * dot(direction, normal);
}

// The sites, or cells of them, as a graph to diffuse on.
struct Graph {
    std::vector<Vec3f> normal, direction;
    std::vector<char> fixed;
    std::vector<std::uint32_t> begin, neighbours;
    std::vector<std::uint32_t> parent;  // in the next coarser graph
    std::size_t size() const { return normal.size(); }
};

// Cells of 2^3 of the finer graph's; a cell is fixed where one of its parts is.
Graph coarser(const Graph& fine, std::vector<Index3>& places, std::vector<std::uint32_t>& parent) {
    std::map<Index3, std::uint32_t> numbers;
    std::vector<Index3> cells;
    parent.resize(fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const Index3 cell{places[i].x >> 1, places[i].y >> 1, places[i].z >> 1};
        const auto [entry, isNew] = numbers.try_emplace(cell, std::uint32_t(cells.size()));
        if (isNew) cells.push_back(cell);
        parent[i] = entry->second;
    }
    Graph graph;
    graph.normal.resize(cells.size());
    graph.direction.resize(cells.size());
    graph.fixed.assign(cells.size(), 0);
    std::vector<std::vector<std::uint32_t>> near(cells.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const std::uint32_t cell = parent[i];
        graph.normal[cell] = graph.normal[cell] + fine.normal[i];
        graph.direction[cell] = graph.direction[cell] + fine.direction[i];
        if (fine.fixed[i]) graph.fixed[cell] = 1;
        for (std::uint32_t k = fine.begin[i]; k < fine.begin[i + 1]; ++k)
            if (parent[fine.neighbours[k]] != cell) near[cell].push_back(parent[fine.neighbours[k]]);
    }
    graph.begin.assign(1, 0);
    for (std::size_t c = 0; c < cells.size(); ++c) {
        graph.normal[c] = normalized(graph.normal[c]);
        graph.direction[c] = normalized(inTangentPlane(graph.direction[c], graph.normal[c]));
        std::sort(near[c].begin(), near[c].end());
        near[c].erase(std::unique(near[c].begin(), near[c].end()), near[c].end());
        graph.neighbours.insert(graph.neighbours.end(), near[c].begin(), near[c].end());
        graph.begin.push_back(std::uint32_t(graph.neighbours.size()));
    }
    places = std::move(cells);
    return graph;
}

// Mean of a site's neighbours' directions, each rotated into its tangent plane.
Vec3f meanAround(const Graph& graph, std::size_t i) {
    Vec3f sum;
    for (std::uint32_t k = graph.begin[i]; k < graph.begin[i + 1]; ++k)
        sum = sum + graph.direction[graph.neighbours[k]];
    return inTangentPlane(sum, graph.normal[i]);
}

void diffuse(Graph& graph, const RunContext& ctx) {
    std::vector<Vec3f> next(graph.size());
    for (int round = 0; round < kRounds; ++round) {
        parallelFor(ctx, graph.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                next[i] = graph.fixed[i] ? graph.direction[i]
                                         : normalized(graph.direction[i] + meanAround(graph, i));
        });
        graph.direction.swap(next);
    }
}

// Coarse to fine; on each level unknown sites start with the coarser level's directions.
void diffuseAll(Graph& graph, std::vector<Index3> places, const RunContext& ctx) {
    const bool open = std::any_of(graph.fixed.begin(), graph.fixed.end(), [](char f) { return !f; });
    if (!open) return;
    if (graph.size() > 64) {
        std::vector<std::uint32_t> parent;
        Graph coarse = coarser(graph, places, parent);
        if (coarse.size() < graph.size()) {
            diffuseAll(coarse, std::move(places), ctx);
            for (std::size_t i = 0; i < graph.size(); ++i)
                if (!graph.fixed[i])
                    graph.direction[i] =
                        normalized(inTangentPlane(coarse.direction[parent[i]], graph.normal[i]));
        }
    }
    diffuse(graph, ctx);
}

// Least sine of the angle to the normal of directions that are kept: kTrusted, or less on a component of the
// surface with less than a quarter of such directions: a slope, or sparse input.
std::vector<float> leastSines(const SurfaceSites& sites, const std::vector<float>& sine) {
    std::vector<float> least(sites.size(), -1);
    std::vector<std::uint32_t> part;
    for (std::uint32_t i = 0; i < sites.size(); ++i) {
        if (least[i] >= 0) continue;
        part.assign(1, i);
        least[i] = 0;
        std::vector<float> sines;
        for (std::size_t k = 0; k < part.size(); ++k) {
            sines.push_back(sine[part[k]]);
            for (std::uint32_t n = sites.begin[part[k]]; n < sites.begin[part[k] + 1]; ++n) {
                const std::uint32_t j = sites.neighbours[n];
                if (least[j] >= 0) continue;
                least[j] = 0;
                part.push_back(j);
            }
        }
        const auto quarter = sines.begin() + std::ptrdiff_t(sines.size() - 1 - sines.size() / 4);
        std::nth_element(sines.begin(), quarter, sines.end());
        for (std::uint32_t j : part) least[j] = std::max(std::min(kTrusted, 0.9f * *quarter), kTooSteep);
    }
    return least;
}

// One site of each connected component of the marked sites.
std::vector<Vec3f> partsOf(const SurfaceSites& sites, std::vector<char> marked) {
    std::vector<Vec3f> places;
    std::vector<std::uint32_t> open;
    for (std::uint32_t i = 0; i < sites.size(); ++i) {
        if (!marked[i]) continue;
        places.push_back(sites.point[i]);
        marked[i] = 0;
        open.assign(1, i);
        while (!open.empty()) {
            const std::uint32_t at = open.back();
            open.pop_back();
            for (std::uint32_t k = sites.begin[at]; k < sites.begin[at + 1]; ++k) {
                const std::uint32_t j = sites.neighbours[k];
                if (!marked[j]) continue;
                marked[j] = 0;
                open.push_back(j);
            }
        }
    }
    return places;
}

// Graph of the sites without any direction.
Graph graphOf(const SurfaceSites& sites) {
    Graph graph;
    graph.normal = sites.normal;
    graph.begin = sites.begin;
    graph.neighbours = sites.neighbours;
    graph.direction.resize(sites.size());
    graph.fixed.assign(sites.size(), 0);
    return graph;
}

// The diffused directions as tangents, and where they are not continuous.
void finish(const SurfaceSites& sites, const Graph& graph, DirectionField& field, const RunContext& ctx) {
    field.tangent.resize(sites.size());
    std::vector<char> singular(sites.size(), 0);
    parallelFor(ctx, sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f& n = sites.normal[i];
            Vec3f t = inTangentPlane(graph.direction[i], n);
            // A component without any given direction takes any tangent.
            if (length(t) < 1e-3f)
                t = inTangentPlane(std::abs(n.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}, n);
            field.tangent[i] = normalized(t);
            const Vec3f sum = graph.direction[i] + meanAround(graph, i);
            singular[i] = length(sum) < kSingular * float(1 + sites.degree(i));
        }
    });
    field.singularities = partsOf(sites, std::move(singular));
}

}  // namespace

DirectionField directionField(const SurfaceSites& sites, const std::vector<Index3>& places,
                              const std::vector<Vec3f>& given, const RunContext& ctx) {
    Graph graph = graphOf(sites);
    DirectionField field;
    std::vector<float> sine(sites.size());
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (dot(given[i], given[i]) > 0)
            sine[i] = length(inTangentPlane(normalized(given[i]), sites.normal[i]));
    const std::vector<float> least = leastSines(sites, sine);
    for (std::size_t i = 0; i < sites.size(); ++i) {
        if (!(sine[i] > least[i])) continue;
        graph.direction[i] = normalized(inTangentPlane(given[i], sites.normal[i]));
        graph.fixed[i] = 1;
        ++field.known;
    }
    if (field.known == 0)
        throw Error(ErrorCode::Unusable,
                    "`direction`: gives no direction on the surface: it is along the normal everywhere, or "
                    "nowhere near the model");
    diffuseAll(graph, places, ctx);
    finish(sites, graph, field, ctx);
    return field;
}

DirectionField directionField(const SurfaceShell& shell, const std::vector<Vec3f>& given,
                              const RunContext& ctx) {
    return directionField(shell, shell.table.voxels(), given, ctx);
}

DirectionField smoothDirectionField(const SurfaceSites& sites, const std::vector<Index3>& places,
                                    const Vec3f& axis, const RunContext& ctx) {
    Graph graph = graphOf(sites);
    for (std::size_t i = 0; i < sites.size(); ++i)
        graph.direction[i] = normalized(inTangentPlane(axis, sites.normal[i]));
    diffuseAll(graph, places, ctx);
    DirectionField field;
    finish(sites, graph, field, ctx);
    return field;
}

std::vector<Index3> sitePlaces(const SurfaceSites& sites, double cell) {
    std::vector<Index3> places;
    places.reserve(sites.size());
    for (const Vec3f& p : sites.point) places.push_back(cellOf(p, cell));
    return places;
}

}  // namespace vdbsynth
