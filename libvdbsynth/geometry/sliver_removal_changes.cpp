// Which collapses and flips would improve a sliver, and what each does to the surface.
#include "libvdbsynth/geometry/sliver_removal_steps.h"
#include "libvdbsynth/geometry/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kTurnOfFace = 0.5;   // least cosine between the normals of a face before and after
constexpr double kTurnOfPatch = 0.2;  // and between that of a new face and the mean of those replaced

// Up to the rounding of coordinates in a plane.
bool within(double moved, double tolerance, double edge) {
    return moved <= tolerance + 1e-6 * edge;
}

}  // namespace

double smallestSine(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    std::array<double, 3> edges{length(b - a), length(c - b), length(a - c)};
    std::sort(edges.begin(), edges.end());
    const double product = edges[1] * edges[2];
    return product > 0 ? length(cross(b - a, c - a)) / product : 0;
}

SliverSurface::SliverSurface(std::vector<Vec3d> points, std::vector<Triangle> triangles, double sine,
                             double tolerance)
    : mPoints(std::move(points)),
      mTriangles(std::move(triangles)),
      mMoved(mTriangles.size(), 0.f),
      mSine(sine),
      mTolerance(tolerance),
      mFirst(mPoints.size() + 1, 0) {
    for (const Triangle& t : mTriangles)
        for (std::uint32_t corner : t) ++mFirst[corner + 1];
    for (std::size_t i = 1; i < mFirst.size(); ++i) mFirst[i] += mFirst[i - 1];
    mFaces.resize(mFirst.back());
    std::vector<std::size_t> next(mFirst.begin(), mFirst.end() - 1);
    for (std::size_t f = 0; f < mTriangles.size(); ++f)
        for (std::uint32_t corner : mTriangles[f]) mFaces[next[corner]++] = std::uint32_t(f);
}

template <typename Visit>
void SliverSurface::forFacesOf(std::uint32_t vertex, const Visit& visit) const {
    const auto changed = mChanged.find(vertex);
    if (changed != mChanged.end())
        for (std::uint32_t face : changed->second) visit(face);
    else
        for (std::size_t i = mFirst[vertex]; i < mFirst[vertex + 1]; ++i) visit(mFaces[i]);
}

std::vector<std::uint32_t>& SliverSurface::editableFaces(std::uint32_t vertex) {
    const auto [at, fresh] = mChanged.try_emplace(vertex);
    if (fresh)
        at->second.assign(mFaces.begin() + std::ptrdiff_t(mFirst[vertex]),
                          mFaces.begin() + std::ptrdiff_t(mFirst[vertex + 1]));
    return at->second;
}

Vec3d SliverSurface::areaVector(const Triangle& t) const {
    return cross(mPoints[t[1]] - mPoints[t[0]], mPoints[t[2]] - mPoints[t[0]]);
}

double SliverSurface::sineOf(const Triangle& t) const {
    return smallestSine(mPoints[t[0]], mPoints[t[1]], mPoints[t[2]]);
}

double SliverSurface::sineOf(std::size_t face) const {
    return sineOf(mTriangles[face]);
}

bool SliverSurface::joined(std::uint32_t a, std::uint32_t b) const {
    bool found = false;
    forFacesOf(a, [&](std::uint32_t face) {
        const Triangle& t = mTriangles[face];
        found = found || t[0] == b || t[1] == b || t[2] == b;
    });
    return found;
}

// The neighbours of a vertex in the order of its faces, which begins at the smallest of them.
// @return false unless its faces form one closed fan
bool SliverSurface::ringOf(std::uint32_t vertex, Ring& ring, std::vector<std::uint32_t>& faces) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> next;
    faces.clear();
    bool simple = true;
    forFacesOf(vertex, [&](std::uint32_t face) {
        const Triangle& t = mTriangles[face];
        const std::size_t at = t[0] == vertex ? 0 : t[1] == vertex ? 1 : 2;
        next.push_back({t[(at + 1) % 3], t[(at + 2) % 3]});
        simple = simple && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        faces.push_back(face);
    });
    std::sort(next.begin(), next.end());
    ring.clear();
    if (!simple || next.size() < 3) return false;
    std::uint32_t at = next.front().first;
    do {
        ring.push_back(at);
        const auto found = std::lower_bound(next.begin(), next.end(), std::make_pair(at, std::uint32_t(0)));
        if (found == next.end() || found->first != at) return false;
        if (found + 1 != next.end() && (found + 1)->first == at) return false;
        at = found->second;
    } while (at != ring.front() && ring.size() <= next.size());
    return ring.size() == next.size();
}

// A collapse of the vertex into ring[apex] keeps the topology if the two share no other neighbours than
// those beside the edge, and if the only triangle left of three is not there already.
bool SliverSurface::linkHolds(std::uint32_t vertex, const Ring& ring, std::size_t apex) const {
    const std::size_t n = ring.size();
    bool holds = true;
    forFacesOf(ring[apex], [&](std::uint32_t face) {
        const Triangle& t = mTriangles[face];
        if (t[0] == vertex || t[1] == vertex || t[2] == vertex) return;
        std::size_t beside = 0;
        for (std::uint32_t corner : t) {
            if (corner == ring[(apex + 1) % n] || corner == ring[(apex + n - 1) % n]) ++beside;
            for (std::size_t i = 2; i + 1 < n; ++i) holds = holds && corner != ring[(apex + i) % n];
        }
        holds = holds && beside < 2;
    });
    return holds;
}

bool SliverSurface::keepsNormals(const SliverChange& change) const {
    Vec3d mean;
    for (std::uint32_t face : change.removed) mean = mean + areaVector(mTriangles[face]);
    mean = normalized(mean);
    for (const Triangle& t : change.added) {
        const Vec3d normal = normalized(areaVector(t));
        if (!(dot(normal, mean) > kTurnOfPatch)) return false;
        // Those with an edge in common: what this one was, and its neighbours.
        for (std::uint32_t face : change.removed) {
            const Triangle& old = mTriangles[face];
            std::size_t common = 0;
            for (std::uint32_t corner : t) common += std::size_t(std::count(old.begin(), old.end(), corner));
            if (common < 2 || sineOf(old) < mSine) continue;
            if (!(dot(normal, normalized(areaVector(old))) > kTurnOfFace)) return false;
        }
    }
    return true;
}

// The largest distance of the removed vertex and of the middles of its edges from the new triangles.
double SliverSurface::movedByCollapse(std::uint32_t vertex, const Ring& ring,
                                      const SliverChange& change) const {
    const auto apart = [&](const Vec3d& p) {
        double nearest = std::numeric_limits<double>::max();
        for (const Triangle& t : change.added) {
            const Vec3d &a = mPoints[t[0]], &b = mPoints[t[1]], &c = mPoints[t[2]];
            const Vec3d share = nearestInTriangle(p, a, b, c);
            nearest = std::min(nearest, length(a * share.x + b * share.y + c * share.z - p));
        }
        return nearest;
    };
    const Vec3d& at = mPoints[vertex];
    double farthest = apart(at);
    for (std::uint32_t end : ring) farthest = std::max(farthest, apart((at + mPoints[end]) * 0.5));
    return farthest;
}

// Fills in what a change is worth, of which `moved` says how far it moves the surface by itself.
// @return false if it is not allowed or no improvement
bool SliverSurface::measure(SliverChange& change) const {
    double before = 1, earlier = 0;
    change.sine = 1;
    change.gain = 0;
    for (std::uint32_t face : change.removed) {
        const double sine = sineOf(face);
        before = std::min(before, sine);
        change.gain += sine < mSine ? 1 : 0;
        earlier = std::max(earlier, double(mMoved[face]));
    }
    for (const Triangle& t : change.added) {
        const double sine = sineOf(t);
        change.sine = std::min(change.sine, sine);
        change.gain -= sine < mSine ? 1 : 0;
    }
    change.moved += earlier;
    if (change.gain < 0 || (change.gain == 0 && !(change.sine > before))) return false;
    return change.sine > 0 && keepsNormals(change);
}

void SliverSurface::tryCollapses(std::uint32_t vertex, SliverChange& best) const {
    SliverChange change;
    Ring ring;
    if (!ringOf(vertex, ring, change.removed)) return;
    const std::size_t n = ring.size();
    for (std::size_t apex = 0; apex < n; ++apex) {
        change.added.clear();
        for (std::size_t i = 1; i + 1 < n; ++i)
            change.added.push_back({ring[apex], ring[(apex + i) % n], ring[(apex + i + 1) % n]});
        change.moved = 0;
        if (!measure(change) || !change.better(best) || !linkHolds(vertex, ring, apex)) continue;
        change.moved += movedByCollapse(vertex, ring, change);
        if (!within(change.moved, mTolerance, length(mPoints[vertex] - mPoints[ring[apex]]))) continue;
        best = change;
    }
}

void SliverSurface::tryFlip(std::uint32_t a, std::uint32_t b, SliverChange& best) const {
    SliverChange change;
    change.flip = true;
    std::array<std::uint32_t, 2> opposite{};
    std::size_t forward = 0;
    forFacesOf(a, [&](std::uint32_t face) {
        const Triangle& t = mTriangles[face];
        for (std::size_t i = 0; i < 3; ++i) {
            const bool along = t[i] == a && t[(i + 1) % 3] == b;
            if (!along && !(t[i] == b && t[(i + 1) % 3] == a)) continue;
            opposite[along ? 0 : 1] = t[(i + 2) % 3];
            forward += along ? 1 : 0;
            change.removed.push_back(face);
        }
    });
    const auto [c, d] = opposite;
    if (change.removed.size() != 2 || forward != 1 || c == d || joined(c, d)) return;
    change.added = {{a, d, c}, {d, b, c}};
    // Over a convex outline two pairs of triangles are farthest apart where their diagonals cross.
    const Vec3d along = mPoints[b] - mPoints[a], normal = cross(along, mPoints[d] - mPoints[c]);
    if (!(dot(normal, normal) > 0)) return;
    change.moved = std::abs(dot(normalized(normal), mPoints[c] - mPoints[a]));
    if (!measure(change) || !change.better(best) || !within(change.moved, mTolerance, length(along))) return;
    best = std::move(change);
}

bool SliverSurface::bestChange(std::size_t face, SliverChange& best) const {
    const Triangle corners = mTriangles[face];
    best = {};
    for (std::size_t i = 0; i < 3; ++i) {
        tryFlip(corners[i], corners[(i + 1) % 3], best);
        tryCollapses(corners[i], best);
    }
    return !best.removed.empty();
}

void SliverSurface::apply(const SliverChange& change) {
    for (std::uint32_t face : change.removed)
        for (std::uint32_t corner : mTriangles[face]) {
            std::vector<std::uint32_t>& faces = editableFaces(corner);
            faces.erase(std::remove(faces.begin(), faces.end(), face), faces.end());
        }
    for (std::size_t i = 0; i < change.removed.size(); ++i) {
        const std::uint32_t face = change.removed[i];
        mMoved[face] = std::nextafter(float(change.moved), std::numeric_limits<float>::max());
        mTriangles[face] = i < change.added.size() ? change.added[i] : Triangle{0, 0, 0};
        if (i < change.added.size())
            for (std::uint32_t corner : mTriangles[face]) editableFaces(corner).push_back(face);
    }
}

std::vector<Triangle> SliverSurface::triangles() const {
    std::vector<Triangle> left;
    for (std::size_t face = 0; face < mTriangles.size(); ++face)
        if (alive(face)) left.push_back(mTriangles[face]);
    return left;
}

}  // namespace vdbsynth
