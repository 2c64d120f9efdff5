#include "libvdbsynth/geometry/crease.h"

#include <algorithm>
#include <map>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kCosine = 0.94;  // of the angle beyond which two normals belong to two faces
constexpr std::uint32_t kNone = 0xffffffffu;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge edgeOf(std::uint32_t a, std::uint32_t b) {
    return {std::min(a, b), std::max(a, b)};
}

class Restorer {
public:
    Restorer(Mesh& mesh, std::vector<VertexSurface>& surfaces, double reach)
        : mMesh(mesh), mSurfaces(surfaces), mReach(reach) {}

    void run() {
        const std::vector<Triangle> triangles = triangulated(mMesh);
        mMesh.triangles.clear();
        mMesh.quads.clear();
        for (const Triangle& t : triangles) {
            std::uint32_t split[3];
            for (std::size_t k = 0; k < 3; ++k) split[k] = vertexOn(edgeOf(t[k], t[(k + 1) % 3]));
            divide(t, split);
        }
    }

private:
    // A vertex where some planes meet, kNone if they meet in no crease or too far away.
    std::uint32_t meeting(const Quadric& planes, const Vec3d& start, int rank) {
        const Quadric::Minimum best = planes.minimum(start, 0.003, rank == 3 ? 0.02 : 1);
        if (best.rank < rank || length(best.point - start) > mReach) return kNone;
        mMesh.points.push_back(cast<float>(best.point));
        mSurfaces.push_back({planes, Vec3d{}, best.rank});
        return std::uint32_t(mMesh.points.size() - 1);
    }

    static Quadric planeOf(const VertexSurface& surface, const Vec3f& at) {
        Quadric plane;
        plane.add(surface.normal, cast<double>(at));
        return plane;
    }

    std::uint32_t vertexOn(const Edge& edge) {
        const auto [found, fresh] = mSplit.try_emplace(edge, kNone);
        if (!fresh) return found->second;
        const VertexSurface &a = mSurfaces[edge.first], &b = mSurfaces[edge.second];
        if (a.rank != 1 || b.rank != 1 || dot(a.normal, b.normal) > kCosine) return kNone;
        const Vec3f pa = mMesh.points[edge.first], pb = mMesh.points[edge.second];
        Quadric planes = planeOf(a, pa);
        planes.add(b.normal, cast<double>(pb));
        return found->second = meeting(planes, (cast<double>(pa) + cast<double>(pb)) * 0.5, 2);
    }

    // A vertex in the corner that a triangle cuts off, kNone if it cuts off none.
    std::uint32_t cornerOf(const Triangle& t, int splits) {
        int creased = 0, corners = 0;
        Quadric planes;
        Vec3d middle;
        for (std::uint32_t v : t) {
            creased += mSurfaces[v].rank == 2;
            corners += mSurfaces[v].rank == 3;
            planes.add(mSurfaces[v].planes);
            middle = middle + cast<double>(mMesh.points[v]) * (1.0 / 3);
        }
        const bool possible = splits == 3 || (corners == 0 && splits == 1 && creased == 1) ||
                              (corners == 0 && splits == 0 && creased >= 2);
        if (!possible) return kNone;
        return meeting(planes, middle, 3);
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) { mMesh.triangles.push_back({a, b, c}); }

    void divide(const Triangle& t, const std::uint32_t (&split)[3]) {
        const int splits = int(
            std::count_if(std::begin(split), std::end(split), [](std::uint32_t v) { return v != kNone; }));
        const std::uint32_t corner = cornerOf(t, splits);
        if (corner != kNone) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[(k + 1) % 3];
                if (split[k] == kNone) {
                    add(a, b, corner);
                } else {
                    add(a, split[k], corner);
                    add(split[k], b, corner);
                }
            }
            return;
        }
        if (splits == 0) return add(t[0], t[1], t[2]);
        if (splits == 3) {
            for (std::size_t k = 0; k < 3; ++k) add(t[k], split[k], split[(k + 2) % 3]);
            return add(split[0], split[1], split[2]);
        }
        // Rotated so that the first edge is the only split one, or the only unsplit one.
        std::size_t k = 0;
        while ((split[k] != kNone) != (splits == 1)) ++k;
        const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
        if (splits == 1) {
            add(a, split[k], c);
            add(split[k], b, c);
            return;
        }
        const std::uint32_t onB = split[(k + 1) % 3], onC = split[(k + 2) % 3];
        add(onB, c, onC);
        const auto apart = [&](std::uint32_t p, std::uint32_t q) {
            return length(mMesh.points[p] - mMesh.points[q]);
        };
        if (apart(a, onB) <= apart(b, onC)) {
            add(a, b, onB);
            add(a, onB, onC);
        } else {
            add(a, b, onC);
            add(b, onB, onC);
        }
    }

    Mesh& mMesh;
    std::vector<VertexSurface>& mSurfaces;
    double mReach;
    std::map<Edge, std::uint32_t> mSplit;
};

}  // namespace

std::size_t restoreCreases(Mesh& mesh, std::vector<VertexSurface>& surfaces, double reach) {
    const std::size_t before = mesh.points.size();
    Restorer(mesh, surfaces, reach).run();
    return mesh.points.size() - before;
}

}  // namespace vdbsynth
