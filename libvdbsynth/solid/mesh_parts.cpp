#include "libvdbsynth/solid/mesh_parts.h"

#include "libvdbsynth/distance/winding_number.h"
#include "libvdbsynth/math/disjoint_sets.h"
#include "libvdbsynth/math/index_box.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kNearlyClosed = 0.3;  // of its area, the sum of its area vectors
constexpr std::size_t kSamples = 64;   // faces that decide where a part lies

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

struct Corners {
    Vec3d a, b, c;
    Vec3d middle() const { return (a + b + c) * (1.0 / 3); }
    Vec3d areaVector() const { return cross(b - a, c - a) * 0.5; }
};

Corners cornersOf(const Mesh& mesh, const Triangle& t) {
    return {cast<double>(mesh.points[t[0]]), cast<double>(mesh.points[t[1]]),
            cast<double>(mesh.points[t[2]])};
}

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
            const Corners face = cornersOf(mMesh, mTriangles[f]);
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
            const Corners face = cornersOf(mMesh, mTriangles[f]);
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

// The boxes around a place, by the cells of a coarse lattice.
class BoxesAt {
public:
    explicit BoxesAt(const std::vector<MeshPart>& parts) : mParts(parts), mCells(latticeCount(kSize)) {
        if (parts.empty()) return;
        mMin = parts[0].boxMin;
        mMax = parts[0].boxMax;
        for (const MeshPart& part : parts)
            for (int axis = 0; axis < 3; ++axis) {
                mMin[axis] = std::min(mMin[axis], part.boxMin[axis]);
                mMax[axis] = std::max(mMax[axis], part.boxMax[axis]);
            }
    }
    void add(std::uint32_t part) {
        forEachVoxel({cellOf(mParts[part].boxMin), cellOf(mParts[part].boxMax)},
                     [&](const Index3& cell) { mCells[latticeIndex(cell, kSize)].push_back(part); });
    }
    /// Parts that were added and whose boxes may contain a place, in the order they were added.
    const std::vector<std::uint32_t>& at(const Vec3d& place) const {
        return mCells[latticeIndex(cellOf(place), kSize)];
    }

private:
    static constexpr int kCells = 16;
    static constexpr Index3 kSize{kCells, kCells, kCells};
    Index3 cellOf(const Vec3d& p) const {
        Index3 cell;
        for (int axis = 0; axis < 3; ++axis) {
            const double side = mMax[axis] - mMin[axis];
            cell[axis] = side > 0 ? std::min(kCells - 1, int((p[axis] - mMin[axis]) / side * kCells)) : 0;
        }
        return cell;
    }
    const std::vector<MeshPart>& mParts;
    std::vector<std::vector<std::uint32_t>> mCells;
    Vec3d mMin, mMax;
};

// Which part lies in which.
class Nesting {
public:
    Nesting(const Mesh& mesh, const std::vector<Triangle>& triangles, MeshParts& parts, const RunContext& ctx)
        : mMesh(mesh), mTriangles(triangles), mParts(parts), mContext(ctx) {
        for (std::uint32_t i = 0; i < mParts.parts.size(); ++i)
            if (mParts.parts[i].role != PartRole::Open) mOrder.push_back(i);
        // The largest first: a part is only ever inside one before it.
        std::stable_sort(mOrder.begin(), mOrder.end(),
                         [this](std::uint32_t a, std::uint32_t b) { return volumeOf(a) > volumeOf(b); });
        mFirst.assign(mParts.parts.size() + 1, 0);
        for (std::uint32_t part : mParts.partOf) ++mFirst[part + 1];
        std::partial_sum(mFirst.begin(), mFirst.end(), mFirst.begin());
        mFaces.resize(mTriangles.size());
        std::vector<std::size_t> next(mFirst.begin(), mFirst.end() - 1);
        for (std::uint32_t f = 0; f < mTriangles.size(); ++f) mFaces[next[mParts.partOf[f]]++] = f;
    }

    void run() {
        BoxesAt larger(mParts.parts);
        for (const std::uint32_t number : mOrder) {
            throwIfCancelled(mContext);
            MeshPart& part = mParts.parts[number];
            // Of the parts before it the smallest that it lies in.
            const std::vector<std::uint32_t>& around = larger.at(part.boxMin);
            for (std::size_t i = around.size(); i-- > 0 && part.around < 0;)
                if (liesIn(number, around[i])) part.around = int(around[i]);
            part.role = roleOf(part);
            larger.add(number);
        }
    }

private:
    double volumeOf(std::uint32_t i) const { return std::abs(mParts.parts[i].signedVolume); }

    PartRole roleOf(const MeshPart& part) const {
        if (part.around < 0) return PartRole::Solid;
        const MeshPart& around = mParts.parts[std::size_t(part.around)];
        const bool opposed = (part.signedVolume < 0) != (around.signedVolume < 0);
        if (!opposed) return PartRole::United;
        return insideIsSolid(around) ? PartRole::Cavity : PartRole::Solid;
    }

    bool insideIsSolid(const MeshPart& part) const {
        if (part.role != PartRole::United) return part.role == PartRole::Solid;
        return insideIsSolid(mParts.parts[std::size_t(part.around)]);
    }

    bool liesIn(std::uint32_t inner, std::uint32_t outer) {
        const MeshPart &a = mParts.parts[inner], &b = mParts.parts[outer];
        for (int axis = 0; axis < 3; ++axis)
            if (a.boxMin[axis] < b.boxMin[axis] || a.boxMax[axis] > b.boxMax[axis]) return false;
        const WindingNumber& winding = windingOf(outer);
        const std::size_t count = mFirst[inner + 1] - mFirst[inner];
        const std::size_t step = std::max<std::size_t>(1, count / kSamples);
        std::size_t inside = 0, tried = 0;
        for (std::size_t i = mFirst[inner]; i < mFirst[inner + 1]; i += step) {
            const double w = std::abs(winding.at(cornersOf(mMesh, mTriangles[mFaces[i]]).middle()));
            if (w < 0.25) return false;
            ++tried;
            inside += w > 0.75 ? 1 : 0;
        }
        // Faces that touch the outer part from inside see a half, as do all of a part that coincides with it.
        return 4 * inside >= 3 * tried;
    }

    const WindingNumber& windingOf(std::uint32_t part) {
        std::unique_ptr<WindingNumber>& winding = mWinding[part];
        if (!winding) {
            Mesh alone;
            for (std::size_t i = mFirst[part]; i < mFirst[part + 1]; ++i) {
                const std::uint32_t first = std::uint32_t(alone.points.size());
                for (std::uint32_t corner : mTriangles[mFaces[i]])
                    alone.points.push_back(mMesh.points[corner]);
                alone.triangles.push_back({first, first + 1, first + 2});
            }
            winding = std::make_unique<WindingNumber>(alone, mContext);
        }
        return *winding;
    }

    const Mesh& mMesh;
    const std::vector<Triangle>& mTriangles;
    MeshParts& mParts;
    const RunContext& mContext;
    std::vector<std::uint32_t> mOrder, mFaces;
    std::vector<std::size_t> mFirst;
    std::map<std::uint32_t, std::unique_ptr<WindingNumber>> mWinding;
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
    Nesting(mesh, triangles, parts, ctx).run();
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
