#include "libvdbsynth/geometry/rest_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/triangle.h"
#include "libvdbsynth/math/nearest_frame.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

namespace vdbsynth {
namespace {

using Axes = std::array<Vec3d, 3>;

constexpr Axes kUnturned{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};

double volumeOf(const Axes& a) {
    return dot(a[0], cross(a[1], a[2]));
}

Vec3d pointOf(const Mesh& mesh, std::uint32_t vertex) {
    return cast<double>(mesh.points[vertex]) + mesh.origin;
}

// The frame of a face: along its first edge, across it, its normal. False where the face has no area.
bool faceFrame(const Mesh& mesh, const Triangle& t, Axes& frame, double& area) {
    const Vec3d a = pointOf(mesh, t[0]), b = pointOf(mesh, t[1]), c = pointOf(mesh, t[2]);
    const Vec3d normal = cross(b - a, c - a);
    area = 0.5 * length(normal);
    if (!(area > 0) || !(length(b - a) > 0)) return false;
    frame[0] = normalized(b - a);
    frame[2] = normalized(normal);
    frame[1] = cross(frame[2], frame[0]);
    return true;
}

// Where the world's axes go when one frame is turned into another.
Axes turnBetween(const Axes& from, const Axes& to) {
    Axes turn;
    for (int axis = 0; axis < 3; ++axis)
        turn[std::size_t(axis)] = to[0] * from[0][axis] + to[1] * from[1][axis] + to[2] * from[2][axis];
    return turn;
}

Axes orthonormal(const Axes& turn) {
    Axes result;
    result[0] = normalized(turn[0]);
    result[2] = normalized(cross(turn[0], turn[1]));
    result[1] = cross(result[2], result[0]);
    return result;
}

struct VertexSum {
    Axes sum{};
    Axes largest = kUnturned;  // rotation of the largest face
    double area = 0, largestArea = 0;
};

Axes turnOf(const VertexSum& vertex) {
    if (!(vertex.area > 0)) return kUnturned;
    const Axes mean{vertex.sum[0] * (1 / vertex.area), vertex.sum[1] * (1 / vertex.area),
                    vertex.sum[2] * (1 / vertex.area)};
    // Faces that turned in opposite ways have no mean.
    constexpr double kLeast = 0.05;
    return volumeOf(mean) > kLeast ? nearestFrame(mean) : vertex.largest;
}

// Triangles in one order, each from its least corner.
std::vector<Triangle> ordered(const Mesh& mesh) {
    std::vector<Triangle> triangles = triangulated(mesh);
    for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

// The directed edges of triangles without those that are run through both ways: the outlines of their parts.
std::map<std::array<std::uint32_t, 2>, int> outlineOf(const std::vector<Triangle>& triangles) {
    std::map<std::array<std::uint32_t, 2>, int> edges;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    for (auto edge = edges.begin(); edge != edges.end();)
        edge = edge->second == 0 ? edges.erase(edge) : ++edge;
    return edges;
}

// A polygon that is concave in one pose only is split there, or along another diagonal.
bool differBySplits(const Mesh& rest, const Mesh& posed) {
    const std::vector<Triangle> a = ordered(rest), b = ordered(posed);
    if (a.size() != b.size()) return false;
    std::vector<Triangle> onlyRest, onlyPosed;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(onlyRest));
    std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::back_inserter(onlyPosed));
    // Of closed meshes with nothing in common both outlines are empty.
    return 2 * onlyRest.size() <= a.size() && outlineOf(onlyRest) == outlineOf(onlyPosed);
}

void requireSameFaces(const Mesh& rest, const Mesh& posed) {
    if (rest.faceCount() == 0) throw Error(ErrorCode::EmptyInput, "the mesh at rest has no faces");
    const auto counts = [](const Mesh& mesh) {
        return std::to_string(mesh.points.size()) + " vertices and " + countText(mesh.faceCount(), "face");
    };
    const bool same = rest.triangles == posed.triangles && rest.quads == posed.quads;
    if (rest.points.size() == posed.points.size() && (same || differBySplits(rest, posed))) return;
    if (rest.points.size() != posed.points.size() || rest.faceCount() != posed.faceCount())
        throw Error(ErrorCode::ShapeMismatch, "the mesh at rest has " + counts(rest) + ", the posed one " +
                                                  counts(posed) + "; both must have the same faces");
    throw Error(ErrorCode::ShapeMismatch,
                "the mesh at rest and the posed one have as many faces, but not the same ones");
}

}  // namespace

RestMap::RestMap(const Mesh& rest, const Mesh& posed) : mRest(rest), mPosed(posed) {
    requireSameFaces(rest, posed);
    // Quads are split as those at rest are, whatever diagonal is shorter in the pose.
    mRest.triangles = mPosed.triangles = triangulated(rest);
    mRest.quads = mPosed.quads = {};
    mRest.attributes = mPosed.attributes = {};
    std::vector<VertexSum> sums(mRest.points.size());
    for (const Triangle& t : mRest.triangles) {
        Axes from, to;
        double restArea = 0, area = 0;
        if (!faceFrame(mRest, t, from, restArea) || !faceFrame(mPosed, t, to, area)) continue;
        const Axes turn = turnBetween(from, to);
        for (const std::uint32_t vertex : t) {
            VertexSum& sum = sums[vertex];
            for (std::size_t axis = 0; axis < 3; ++axis)
                sum.sum[axis] = sum.sum[axis] + turn[axis] * restArea;
            sum.area += restArea;
            if (restArea > sum.largestArea) {
                sum.largest = turn;
                sum.largestArea = restArea;
            }
        }
    }
    for (const VertexSum& sum : sums) mTurn.push_back(turnOf(sum));
}

RestPlace RestMap::at(const Vec3d& place, std::uint32_t face) const {
    const Triangle& t = mPosed.triangles[face];
    const Vec3d a = pointOf(mPosed, t[0]), b = pointOf(mPosed, t[1]), c = pointOf(mPosed, t[2]);
    const Vec3d w = nearestInTriangle(place, a, b, c);
    const Vec3d away = place - (a * w.x + b * w.y + c * w.z);
    const Vec3d foot = pointOf(mRest, t[0]) * w.x + pointOf(mRest, t[1]) * w.y + pointOf(mRest, t[2]) * w.z;
    Axes turn;
    for (std::size_t axis = 0; axis < 3; ++axis)
        turn[axis] = mTurn[t[0]][axis] * w.x + mTurn[t[1]][axis] * w.y + mTurn[t[2]][axis] * w.z;
    turn = orthonormal(turn);
    return {foot + Vec3d{dot(turn[0], away), dot(turn[1], away), dot(turn[2], away)}, turn};
}

}  // namespace vdbsynth
