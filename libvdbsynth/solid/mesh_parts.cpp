#include "libvdbsynth/solid/mesh_parts.h"

#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/solid/mesh_parts_steps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kNearlyClosed = 0.3;  // of its area, the sum of its area vectors

// One face at an edge, under the edge's lower vertex.
struct Half {
    std::uint32_t high, face;
    bool forward;
};

// The faces at every edge: visit(first, last) for each edge, in the order of its vertices.
class Edges {
public:
    explicit Edges(const std::vector<Triangle>& triangles, std::size_t vertices) {
        mBegin.assign(vertices + 1, 0);
        const auto forEdges = [&](auto&& use) {
            for (std::uint32_t f = 0; f < triangles.size(); ++f)
                for (std::size_t i = 0; i < 3; ++i) use(triangles[f][i], triangles[f][(i + 1) % 3], f);
        };
        forEdges([&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++mBegin[std::min(a, b) + 1]; });
        std::partial_sum(mBegin.begin(), mBegin.end(), mBegin.begin());
        mHalves.resize(mBegin.back());
        std::vector<std::uint32_t> next(mBegin.begin(), mBegin.end() - 1);
        forEdges([&](std::uint32_t a, std::uint32_t b, std::uint32_t f) {
            mHalves[next[std::min(a, b)]++] = {std::max(a, b), f, a < b};
        });
        for (std::size_t v = 0; v < vertices; ++v)
            std::sort(mHalves.begin() + mBegin[v], mHalves.begin() + mBegin[v + 1],
                      [](const Half& x, const Half& y) {
                          return x.high != y.high ? x.high < y.high : x.face < y.face;
                      });
    }

    template <typename Visit>
    void forEach(Visit&& visit) const {
        for (std::size_t v = 0; v + 1 < mBegin.size(); ++v)
            for (std::uint32_t i = mBegin[v]; i < mBegin[v + 1];) {
                const std::uint32_t first = i;
                while (i < mBegin[v + 1] && mHalves[i].high == mHalves[first].high) ++i;
                visit(mHalves.data() + first, mHalves.data() + i);
            }
    }

private:
    std::vector<std::uint32_t> mBegin;
    std::vector<Half> mHalves;
};

// Part by part, what its faces sum to; `closed` if every edge is balanced within the part.
class PartSums {
public:
    PartSums(const Mesh& mesh, const std::vector<Triangle>& triangles, MeshParts& parts)
        : mMesh(mesh), mTriangles(triangles), mParts(parts) {}

    void run(const Edges& edges) {
        DisjointSets sets(mTriangles.size());
        edges.forEach([&](const Half* first, const Half* last) {
            if (last - first == 2) sets.join(first[0].face, first[1].face);
        });
        number(sets);
        sum();
        markOpen(edges);
    }

private:
    void number(DisjointSets& sets) {
        std::vector<std::uint32_t>& partOf = mParts.partOf;
        partOf.resize(mTriangles.size());
        for (std::uint32_t f = 0; f < mTriangles.size(); ++f) {
            const std::uint32_t root = sets.root(f);
            if (root == f) {
                partOf[f] = std::uint32_t(mParts.parts.size());
                mParts.parts.emplace_back();
            } else {
                partOf[f] = partOf[root];
            }
        }
    }

    // Volumes about the part's own middle: of a part that is open they mean little about any other point.
    void sum() {
        const std::size_t count = mParts.parts.size();
        std::vector<Vec3d> middle(count), vectors(count);
        for (std::size_t f = 0; f < mTriangles.size(); ++f) {
            MeshPart& part = mParts.parts[mParts.partOf[f]];
            const FaceCorners face = cornersOf(mMesh, mTriangles[f]);
            const Vec3d vector = face.areaVector();
            const double area = length(vector);
            if (part.faces == 0) part.boxMin = part.boxMax = face.a;
            for (const Vec3d& p : {face.a, face.b, face.c})
                for (int axis = 0; axis < 3; ++axis) {
                    part.boxMin[axis] = std::min(part.boxMin[axis], p[axis]);
                    part.boxMax[axis] = std::max(part.boxMax[axis], p[axis]);
                }
            ++part.faces;
            part.area += area;
            middle[mParts.partOf[f]] = middle[mParts.partOf[f]] + face.middle() * area;
            vectors[mParts.partOf[f]] = vectors[mParts.partOf[f]] + vector;
        }
        for (std::size_t i = 0; i < count; ++i) {
            MeshPart& part = mParts.parts[i];
            if (part.area > 0) middle[i] = middle[i] * (1 / part.area);
            if (length(vectors[i]) < kNearlyClosed * part.area) part.role = PartRole::Solid;
        }
        for (std::size_t f = 0; f < mTriangles.size(); ++f) {
            const std::size_t i = mParts.partOf[f];
            const FaceCorners face = cornersOf(mMesh, mTriangles[f]);
            mParts.parts[i].signedVolume +=
                dot(face.a - middle[i], cross(face.b - middle[i], face.c - middle[i])) / 6;
        }
    }

    // A part whose faces disagree has no orientation to speak of, however little is open.
    void markOpen(const Edges& edges) {
        edges.forEach([&](const Half* first, const Half* last) {
            if (last - first == 2 && first[0].forward == first[1].forward)
                mParts.parts[mParts.partOf[first->face]].role = PartRole::Open;
        });
        for (MeshPart& part : mParts.parts)
            if (std::abs(part.signedVolume) < 1e-9 * part.area * std::sqrt(part.area))
                part.role = PartRole::Open;
    }

    const Mesh& mMesh;
    const std::vector<Triangle>& mTriangles;
    MeshParts& mParts;
};

// True for united parts with something opposed in them: their own solid would hide it.
std::vector<char> hidingParts(const MeshParts& parts) {
    std::vector<char> hiding(parts.parts.size(), 0);
    for (const MeshPart& part : parts.parts)
        for (int i = part.around; i >= 0 && part.role != PartRole::United;
             i = parts.parts[std::size_t(i)].around) {
            if (parts.parts[std::size_t(i)].role != PartRole::United) break;
            hiding[std::size_t(i)] = 1;
        }
    return hiding;
}

// A united part has the orientation of what it is united with.
bool looksOutward(const MeshParts& parts, const MeshPart& part) {
    const MeshPart* at = &part;
    while (at->role == PartRole::United) at = &parts.parts[std::size_t(at->around)];
    return at->role == PartRole::Solid;
}

}  // namespace

MeshParts meshParts(const Mesh& mesh, const RunContext& ctx) {
    const std::vector<Triangle> triangles = triangulated(mesh);
    MeshParts parts;
    PartSums(mesh, triangles, parts).run(Edges(triangles, mesh.points.size()));
    throwIfCancelled(ctx);
    findNesting(mesh, triangles, parts, ctx);
    return parts;
}

PartCounts countParts(const MeshParts& parts) {
    PartCounts counts;
    for (const MeshPart& part : parts.parts) {
        counts.solids += part.role == PartRole::Solid ? 1 : 0;
        counts.cavities += part.role == PartRole::Cavity ? 1 : 0;
        counts.united += part.role == PartRole::United ? 1 : 0;
        counts.open += part.role == PartRole::Open ? 1 : 0;
    }
    return counts;
}

OrientedParts orientParts(const Mesh& mesh, const MeshParts& parts) {
    OrientedParts done;
    const std::vector<char> hiding = hidingParts(parts);
    std::vector<char> flip(parts.parts.size(), 0);
    for (std::size_t i = 0; i < parts.parts.size(); ++i) {
        const MeshPart& part = parts.parts[i];
        if (part.role == PartRole::Open) continue;
        flip[i] = looksOutward(parts, part) == (part.signedVolume < 0);
        done.removed += hiding[i] ? 1 : 0;
        done.flipped += flip[i] && !hiding[i] ? 1 : 0;
    }
    if (done.flipped + done.removed == 0) return done;
    const std::vector<Triangle> triangles = triangulated(mesh);
    done.mesh.emplace();
    done.mesh->points = mesh.points;
    done.mesh->origin = mesh.origin;
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const std::size_t part = parts.partOf[f];
        Triangle t = triangles[f];
        if (hiding[part]) continue;
        if (flip[part]) std::swap(t[1], t[2]);
        done.mesh->triangles.push_back(t);
    }
    return done;
}

}  // namespace vdbsynth
