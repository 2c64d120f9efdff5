#include "libvdbsynth/geometry/mesh.h"

#include <algorithm>

namespace vdbsynth {
namespace {

struct Edge {
    std::uint32_t low, high;
    bool forward;  // its face traverses it from low to high
};

std::vector<Edge> sortedEdges(const Mesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(mesh.triangles.size() * 3 + mesh.quads.size() * 4);
    const auto add = [&edges](std::uint32_t a, std::uint32_t b) {
        edges.push_back({std::min(a, b), std::max(a, b), a < b});
    };
    for (const Triangle& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) add(t[i], t[(i + 1) % 3]);
    for (const Quad& q : mesh.quads)
        for (std::size_t i = 0; i < 4; ++i) add(q[i], q[(i + 1) % 4]);
    std::sort(edges.begin(), edges.end(),
              [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    return edges;
}

void countEdges(const Mesh& mesh, MeshSummary& summary) {
    const std::vector<Edge> edges = sortedEdges(mesh);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i;
        std::size_t forward = 0;
        for (; j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j)
            forward += edges[j].forward ? 1 : 0;
        const std::size_t faces = j - i;
        if (faces == 1) ++summary.openEdges;
        if (faces > 2) ++summary.nonManifoldEdges;
        if (faces == 2 && forward != 1) ++summary.misorientedEdges;
        i = j;
    }
}

}  // namespace

std::vector<Triangle> triangulated(const Mesh& mesh) {
    std::vector<Triangle> all;
    all.reserve(mesh.triangles.size() + 2 * mesh.quads.size());
    all = mesh.triangles;
    for (const Quad& q : mesh.quads) {
        const float first = length(mesh.points[q[2]] - mesh.points[q[0]]);
        const float second = length(mesh.points[q[3]] - mesh.points[q[1]]);
        if (first <= second) {
            all.push_back({q[0], q[1], q[2]});
            all.push_back({q[0], q[2], q[3]});
        } else {
            all.push_back({q[0], q[1], q[3]});
            all.push_back({q[1], q[2], q[3]});
        }
    }
    return all;
}

MeshSummary summarize(const Mesh& mesh) {
    MeshSummary summary;
    summary.vertices = mesh.points.size();
    summary.faces = mesh.faceCount();
    const std::vector<Triangle> triangles = triangulated(mesh);
    bool first = true;
    for (const Triangle& t : triangles)
        for (std::uint32_t corner : t) {
            const Vec3d p = cast<double>(mesh.points[corner]);
            for (int axis = 0; axis < 3; ++axis) {
                summary.boxMin[axis] = first ? p[axis] : std::min(summary.boxMin[axis], p[axis]);
                summary.boxMax[axis] = first ? p[axis] : std::max(summary.boxMax[axis], p[axis]);
            }
            first = false;
        }
    const Vec3d centre = (summary.boxMin + summary.boxMax) * 0.5;
    for (const Triangle& t : triangles) {
        const Vec3d a = cast<double>(mesh.points[t[0]]) - centre;
        const Vec3d b = cast<double>(mesh.points[t[1]]) - centre;
        const Vec3d c = cast<double>(mesh.points[t[2]]) - centre;
        summary.signedVolume += dot(a, cross(b, c)) / 6;
        summary.area += length(cross(b - a, c - a)) / 2;
    }
    summary.boxMin = summary.boxMin + mesh.origin;
    summary.boxMax = summary.boxMax + mesh.origin;
    countEdges(mesh, summary);
    return summary;
}

}  // namespace vdbsynth
