// Makes a closed mesh manifold by pairing the faces around each non-manifold edge and giving every fan of
// paired faces its own vertex (the "cutting" of non-manifold surfaces).
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace vdbsynth {
namespace {

// One side of a face: the directed edge from corner `from` to corner `to` (corner numbers count the
// corners of all faces one after another).
struct Side {
    std::uint32_t low, high;  // vertices
    std::uint32_t face, from, to;
    bool forward;
};

struct Faces {
    std::vector<std::uint32_t> first;   // first corner of each face, and one past the last
    std::vector<std::uint32_t> vertex;  // vertex of each corner
};

Faces cornersOf(const Mesh& mesh) {
    Faces faces;
    for (const Triangle& t : mesh.triangles) {
        faces.first.push_back(std::uint32_t(faces.vertex.size()));
        faces.vertex.insert(faces.vertex.end(), t.begin(), t.end());
    }
    for (const Quad& q : mesh.quads) {
        faces.first.push_back(std::uint32_t(faces.vertex.size()));
        faces.vertex.insert(faces.vertex.end(), q.begin(), q.end());
    }
    faces.first.push_back(std::uint32_t(faces.vertex.size()));
    return faces;
}

std::vector<Side> sidesOf(const Faces& faces) {
    std::vector<Side> sides;
    sides.reserve(faces.vertex.size());
    for (std::uint32_t face = 0; face + 1 < faces.first.size(); ++face)
        for (std::uint32_t c = faces.first[face]; c < faces.first[face + 1]; ++c) {
            const std::uint32_t next = c + 1 < faces.first[face + 1] ? c + 1 : faces.first[face];
            const std::uint32_t a = faces.vertex[c], b = faces.vertex[next];
            sides.push_back({std::min(a, b), std::max(a, b), face, c, next, a < b});
        }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.low != b.low ? a.low < b.low : a.high < b.high;
    });
    return sides;
}

// Angle of a face around its edge, seen along the edge from low to high, in [0, 2 pi).
double angleAround(const Mesh& mesh, const Faces& faces, const Side& side) {
    const Vec3d low = cast<double>(mesh.points[side.low]);
    const Vec3d axis = normalized(cast<double>(mesh.points[side.high]) - low);
    Vec3d centre;
    const std::uint32_t begin = faces.first[side.face], end = faces.first[side.face + 1];
    for (std::uint32_t c = begin; c < end; ++c) centre = centre + cast<double>(mesh.points[faces.vertex[c]]);
    const Vec3d out = centre * (1.0 / (end - begin)) - low;
    const Vec3d away = out - axis * dot(out, axis);
    Vec3d u = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    u = normalized(u - axis * dot(u, axis));
    const double angle = arcTangent(dot(away, cross(axis, u)), dot(away, u));
    return angle < 0 ? angle + 6.283185307179586 : angle;
}

void joinAcross(DisjointSets& sets, const Faces& faces, const Side& a, const Side& b) {
    for (std::uint32_t ca : {a.from, a.to})
        for (std::uint32_t cb : {b.from, b.to})
            if (faces.vertex[ca] == faces.vertex[cb]) sets.join(ca, cb);
}

// With outward normals a face that runs forward (low to high) has the solid on its clockwise side about the
// edge, so it pairs with the next backward face in order of descending angle.
void pairAround(DisjointSets& sets, const Mesh& mesh, const Faces& faces, const std::vector<Side>& sides,
                std::size_t begin, std::size_t end) {
    std::vector<std::pair<double, std::size_t>> ring;
    for (std::size_t i = begin; i < end; ++i) ring.emplace_back(angleAround(mesh, faces, sides[i]), i);
    std::sort(ring.begin(), ring.end());
    const std::size_t n = ring.size();
    std::vector<char> used(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        if (!sides[ring[i].second].forward) continue;
        for (std::size_t step = 1; step < n; ++step) {
            const std::size_t j = (i + n - step) % n;
            if (used[j] || sides[ring[j].second].forward) continue;
            used[j] = 1;
            joinAcross(sets, faces, sides[ring[i].second], sides[ring[j].second]);
            break;
        }
    }
}

// Marks vertices that coincide with another: the two sides of a wall thinner than a cell.
void markCoincident(const std::vector<Vec3f>& points, std::vector<char>& marks) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) { return std::make_tuple(points[i].x, points[i].y, points[i].z); };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i)
        if (key(order[i]) == key(order[i - 1])) marks[order[i]] = marks[order[i - 1]] = 1;
}

}  // namespace

std::size_t separateNonManifold(Mesh& mesh, float gap) {
    const Faces faces = cornersOf(mesh);
    const std::vector<Side> sides = sidesOf(faces);
    DisjointSets sets(faces.vertex.size());
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i;
        while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
        if (j - i == 2)
            joinAcross(sets, faces, sides[i], sides[i + 1]);
        else if (j - i > 2)
            pairAround(sets, mesh, faces, sides, i, j);
        i = j;
    }
    // The fan with the smallest corner keeps the vertex; every other fan gets a copy.
    constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    std::vector<std::uint32_t> owner(mesh.points.size(), kNone), newVertex(faces.vertex.size(), kNone);
    const std::size_t before = mesh.points.size();
    std::vector<char> split(before, 0);
    for (std::uint32_t c = 0; c < faces.vertex.size(); ++c) {
        const std::uint32_t root = sets.root(c), v = faces.vertex[c];
        if (root == c && owner[v] == kNone) {
            owner[v] = c;
            newVertex[c] = v;
        } else if (root == c) {
            newVertex[c] = std::uint32_t(mesh.points.size());
            mesh.points.push_back(mesh.points[v]);
            split[v] = 1;
        }
    }
    const std::size_t added = mesh.points.size() - before;
    for (std::size_t v = before; v < mesh.points.size(); ++v) split.push_back(1);
    markCoincident(mesh.points, split);
    if (std::find(split.begin(), split.end(), 1) == split.end()) return 0;
    // A split vertex moves slightly towards the middle of its own fan and behind its face: two coincident
    // sheets are separated by the second where the first is equal for both.
    std::vector<Vec3d> towards(mesh.points.size());
    const std::vector<Vec3f> points = mesh.points;
    for (std::uint32_t face = 0; face + 1 < faces.first.size(); ++face) {
        const std::uint32_t begin = faces.first[face], end = faces.first[face + 1];
        const auto corner = [&](std::uint32_t c) { return cast<double>(points[faces.vertex[c]]); };
        Vec3d centre;
        for (std::uint32_t c = begin; c < end; ++c) centre = centre + corner(c);
        centre = centre * (1.0 / (end - begin));
        const Vec3d normal = cross(corner(begin + 1) - corner(begin), corner(end - 1) - corner(begin));
        for (std::uint32_t c = begin; c < end; ++c) {
            const std::uint32_t v = newVertex[sets.root(c)];
            if (split[v])
                towards[v] = towards[v] + (centre - corner(c)) -
                             normalized(normal) * (0.5 * length(centre - corner(c)));
        }
    }
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        mesh.points[v] = mesh.points[v] + cast<float>(normalized(towards[v]) * double(gap));
    std::uint32_t corner = 0;
    for (Triangle& t : mesh.triangles)
        for (std::uint32_t& v : t) v = newVertex[sets.root(corner++)];
    for (Quad& q : mesh.quads)
        for (std::uint32_t& v : q) v = newVertex[sets.root(corner++)];
    return added;
}

}  // namespace vdbsynth
