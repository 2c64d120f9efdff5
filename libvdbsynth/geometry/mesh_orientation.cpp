// Welding and orienting meshes that were not made as solids.
#include "libvdbsynth/geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vdbsynth {
namespace {

struct FaceEdge {
    std::uint32_t low, high;
    std::uint32_t face;
    bool forward;
};

std::vector<FaceEdge> edgesOf(const std::vector<Triangle>& triangles) {
    std::vector<FaceEdge> edges;
    edges.reserve(triangles.size() * 3);
    for (std::uint32_t face = 0; face < triangles.size(); ++face)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = triangles[face][i], b = triangles[face][(i + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), face, a < b});
        }
    std::sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    return edges;
}

// Two faces at an edge without a third one.
struct Neighbour {
    std::uint32_t face;
    bool agrees;  // traverses the edge in the other direction, as on a consistent surface
};

std::vector<std::vector<Neighbour>> neighboursOf(const std::vector<Triangle>& triangles) {
    const std::vector<FaceEdge> edges = edgesOf(triangles);
    std::vector<std::vector<Neighbour>> neighbours(triangles.size());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i;
        while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
        if (j == i + 2 && edges[i].face != edges[i + 1].face) {
            const bool agrees = edges[i].forward != edges[i + 1].forward;
            neighbours[edges[i].face].push_back({edges[i + 1].face, agrees});
            neighbours[edges[i + 1].face].push_back({edges[i].face, agrees});
        }
        i = j;
    }
    return neighbours;
}

double areaOf(const Mesh& mesh, const Triangle& t) {
    const Vec3d a = cast<double>(mesh.points[t[0]]);
    return length(cross(cast<double>(mesh.points[t[1]]) - a, cast<double>(mesh.points[t[2]]) - a)) / 2;
}

// Volume about the part's own middle: for an open shell, positive if its faces look outward.
double volumeOf(const Mesh& mesh, const std::vector<Triangle>& triangles,
                const std::vector<std::uint32_t>& part, const std::vector<char>& flipped) {
    Vec3d middle;
    double area = 0;
    for (std::uint32_t face : part) {
        const double size = areaOf(mesh, triangles[face]);
        for (std::uint32_t corner : triangles[face])
            middle = middle + cast<double>(mesh.points[corner]) * (size / 3);
        area += size;
    }
    if (area > 0) middle = middle * (1 / area);
    double volume = 0;
    for (std::uint32_t face : part) {
        const Triangle& t = triangles[face];
        const Vec3d a = cast<double>(mesh.points[t[0]]) - middle,
                    b = cast<double>(mesh.points[t[1]]) - middle,
                    c = cast<double>(mesh.points[t[2]]) - middle;
        volume += (flipped[face] ? -1 : 1) * dot(a, cross(b, c)) / 6;
    }
    return volume;
}

// The faces connected with `seed`, oriented consistently with it.
std::vector<std::uint32_t> growPart(const std::vector<std::vector<Neighbour>>& neighbours, std::uint32_t seed,
                                    std::vector<char>& seen, std::vector<char>& flipped) {
    std::vector<std::uint32_t> part{seed};
    seen[seed] = 1;
    for (std::size_t at = 0; at < part.size(); ++at)
        for (const Neighbour& other : neighbours[part[at]]) {
            if (seen[other.face]) continue;
            seen[other.face] = 1;
            flipped[other.face] = other.agrees ? flipped[part[at]] : char(!flipped[part[at]]);
            part.push_back(other.face);
        }
    return part;
}

}  // namespace

EdgeBalance edgeBalance(const Mesh& mesh) {
    // Each edge, as (low, high), once per face: number of forward minus backward traversals.
    std::vector<std::uint32_t> begin(mesh.points.size() + 1, 0);
    const auto forEdges = [&mesh](auto&& visit) {
        for (const Triangle& t : mesh.triangles)
            for (std::size_t i = 0; i < 3; ++i) visit(t[i], t[(i + 1) % 3]);
        for (const Quad& q : mesh.quads)
            for (std::size_t i = 0; i < 4; ++i) visit(q[i], q[(i + 1) % 4]);
    };
    forEdges([&](std::uint32_t a, std::uint32_t b) { ++begin[std::min(a, b) + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    struct Half {
        std::uint32_t high;
        std::int32_t sign;
    };
    std::vector<Half> halves(begin.back());
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
    forEdges([&](std::uint32_t a, std::uint32_t b) {
        halves[next[std::min(a, b)]++] = {std::max(a, b), a == b ? 0 : a < b ? 1 : -1};
    });
    bool manifold = true;
    for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
        std::sort(halves.begin() + begin[v], halves.begin() + begin[v + 1],
                  [](const Half& x, const Half& y) { return x.high < y.high; });
        for (std::uint32_t i = begin[v]; i < begin[v + 1];) {
            std::int32_t sum = 0;
            const std::uint32_t high = halves[i].high, first = i;
            for (; i < begin[v + 1] && halves[i].high == high; ++i) sum += halves[i].sign;
            if (sum != 0) return EdgeBalance::Open;
            manifold = manifold && i - first == 2;
        }
    }
    return manifold ? EdgeBalance::Manifold : EdgeBalance::Balanced;
}

std::size_t weldVertices(Mesh& mesh) {
    std::vector<std::uint32_t> order(mesh.points.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto less = [&mesh](std::uint32_t a, std::uint32_t b) {
        const Vec3f &p = mesh.points[a], &q = mesh.points[b];
        if (p.x != q.x) return p.x < q.x;
        if (p.y != q.y) return p.y < q.y;
        if (p.z != q.z) return p.z < q.z;
        return a < b;
    };
    std::sort(order.begin(), order.end(), less);
    std::vector<std::uint32_t> target(mesh.points.size());
    std::size_t welded = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && mesh.points[order[i]].x == mesh.points[order[i - 1]].x &&
                          mesh.points[order[i]].y == mesh.points[order[i - 1]].y &&
                          mesh.points[order[i]].z == mesh.points[order[i - 1]].z;
        target[order[i]] = same ? target[order[i - 1]] : order[i];
        welded += same ? 1 : 0;
    }
    if (welded == 0) return 0;
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& corner : t) corner = target[corner];
    for (Quad& q : mesh.quads)
        for (std::uint32_t& corner : q) corner = target[corner];
    return welded;
}

namespace {

// Two-sided quads may split along different diagonals, so they are compared whole. @return number removed
std::size_t removeDuplicateQuads(Mesh& mesh) {
    std::vector<std::pair<Quad, std::uint32_t>> keys;
    for (std::uint32_t i = 0; i < mesh.quads.size(); ++i) {
        keys.push_back({mesh.quads[i], i});
        std::sort(keys.back().first.begin(), keys.back().first.end());
    }
    std::sort(keys.begin(), keys.end());
    std::vector<char> keep(mesh.quads.size(), 1);
    for (std::size_t i = 1; i < keys.size(); ++i)
        if (keys[i].first == keys[i - 1].first) keep[keys[i].second] = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
        if (keep[i]) mesh.quads[kept++] = mesh.quads[i];
    const std::size_t removed = mesh.quads.size() - kept;
    mesh.quads.resize(kept);
    return removed;
}

}  // namespace

std::size_t removeDuplicateFaces(Mesh& mesh) {
    const std::size_t quads = removeDuplicateQuads(mesh);
    std::vector<Triangle> triangles = triangulated(mesh);
    mesh.quads.clear();
    mesh.triangles.clear();
    std::vector<Triangle> keys = triangles;
    for (Triangle& key : keys) std::sort(key.begin(), key.end());
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&keys](std::uint32_t a, std::uint32_t b) {
        return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
    });
    std::vector<char> keep(triangles.size(), 0);
    std::size_t duplicates = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Triangle& key = keys[order[i]];
        if (key[0] == key[1] || key[1] == key[2]) continue;
        const bool again = i > 0 && keys[order[i - 1]] == key;
        keep[order[i]] = !again;
        duplicates += again ? 1 : 0;
    }
    for (std::size_t i = 0; i < triangles.size(); ++i)
        if (keep[i]) mesh.triangles.push_back(triangles[i]);
    return duplicates + 2 * quads;
}

std::size_t orientFaces(Mesh& mesh) {
    mesh.triangles = triangulated(mesh);
    mesh.quads.clear();
    const std::vector<std::vector<Neighbour>> neighbours = neighboursOf(mesh.triangles);
    std::vector<char> seen(mesh.triangles.size(), 0), flipped(mesh.triangles.size(), 0);
    double total = 0;
    std::size_t flips = 0;
    for (std::uint32_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (seen[seed]) continue;
        const std::vector<std::uint32_t> part = growPart(neighbours, seed, seen, flipped);
        double flippedArea = 0, area = 0;
        for (std::uint32_t face : part) {
            const double size = areaOf(mesh, mesh.triangles[face]);
            area += size;
            flippedArea += flipped[face] ? size : 0;
        }
        // A consistent part keeps its orientation, which may be that of a cavity. In a mixed one the clear
        // majority was right; without one it is oriented outward.
        const bool flipPart = flippedArea > 0.4 * area && flippedArea < 0.6 * area
                                  ? volumeOf(mesh, mesh.triangles, part, flipped) < 0
                                  : flippedArea > 0.5 * area;
        if (flipPart)
            for (std::uint32_t face : part) flipped[face] = char(!flipped[face]);
        total += volumeOf(mesh, mesh.triangles, part, flipped);
    }
    const bool insideOut = total < 0;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        if (bool(flipped[face]) == insideOut) continue;
        std::swap(mesh.triangles[face][1], mesh.triangles[face][2]);
        ++flips;
    }
    return flips;
}

}  // namespace vdbsynth
