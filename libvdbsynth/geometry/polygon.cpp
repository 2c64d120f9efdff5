#include "libvdbsynth/geometry/polygon.h"

#include "libvdbsynth/geometry/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

// Of a quad's area: a corner that dents it by less counts as straight.
constexpr double kStraight = 1e-6;
// The cosine of normals from which on two triangles lie on each other.
constexpr double kOpposite = -0.999;
// Of the squared length: a smaller area is rounding.
constexpr double kNoArea = 1e-12;

// Of the size: polygons that are thicker are folded, and their triangles matter to the area.
constexpr double kFlat = 1e-3;
// Corners up to which folded polygons get the triangles of least area, at a cost of their number cubed.
constexpr std::size_t kMostFolded = 16;
// Of the area: less of it flipped is rounding.
constexpr double kFlippedShare = 1e-6;

// Every polygon in turn, with shared buffers.
class PolygonCutter {
public:
    PolygonCutter(Mesh& mesh, const std::vector<Vec3d>& points) : mMesh(mesh), mPoints(points) {}

    // Returns false if the polygon crosses itself.
    bool add(const std::uint32_t* corners, std::size_t count) {
        if (count < 3) return true;
        if (count == 3) {
            mMesh.triangles.push_back({corners[0], corners[1], corners[2]});
            return true;
        }
        if (count == 4) return addQuad(corners);
        const bool hasArea = project(corners, count);
        if (hasArea && !mFlat && count <= kMostFolded) return addFolded(corners, count);
        if (!hasArea || isConvex()) {
            for (std::size_t i = 1; i + 1 < count; ++i)
                mMesh.triangles.push_back({corners[0], corners[i], corners[i + 1]});
            return true;
        }
        const bool simple = mClipper.triangulate(mRing, mTriangles);
        for (const Triangle& t : mTriangles) {
            const Triangle face{corners[t[0]], corners[t[1]], corners[t[2]]};
            // The end of a bridge, there and back.
            if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
            mMesh.triangles.push_back(face);
        }
        return simple;
    }

private:
    bool addQuad(const std::uint32_t* q);
    bool addFolded(const std::uint32_t* corners, std::size_t count);
    bool project(const std::uint32_t* corners, std::size_t count);
    bool isConvex() const;

    Mesh& mMesh;
    const std::vector<Vec3d>& mPoints;
    EarClipper mClipper;
    Vec3d mNormal;
    bool mFlat = true;
    std::vector<double> mAlong, mAcross;  // in the polygon's plane
    std::vector<PlanePoint> mRing;
    std::vector<Triangle> mTriangles;
};

// A diagonal is inside if the triangles on its sides face the same way.
bool PolygonCutter::addQuad(const std::uint32_t* q) {
    Vec3d normal[4];
    double most = 0;
    for (int i = 0; i < 4; ++i) {
        const Vec3d& p = mPoints[q[i]];
        normal[i] = cross(mPoints[q[(i + 1) % 4]] - p, mPoints[q[(i + 3) % 4]] - p);
        most = std::max(most, dot(normal[i], normal[i]));
    }
    const bool first = dot(normal[1], normal[3]) >= -kStraight * most;
    const bool second = dot(normal[0], normal[2]) >= -kStraight * most;
    if (first == second) {
        mMesh.quads.push_back({q[0], q[1], q[2], q[3]});
    } else if (first) {
        mMesh.triangles.push_back({q[0], q[1], q[2]});
        mMesh.triangles.push_back({q[0], q[2], q[3]});
    } else {
        mMesh.triangles.push_back({q[0], q[1], q[3]});
        mMesh.triangles.push_back({q[1], q[2], q[3]});
    }
    // Twisted quads fail as well; in those that cross themselves the triangles are flat on each other.
    const auto opposite = [&](const Vec3d& a, const Vec3d& b) {
        return dot(a, b) < kOpposite * length(a) * length(b);
    };
    return first || second || !opposite(normal[1], normal[3]) || !opposite(normal[0], normal[2]);
}

// From the least areas of all shorter chains of corners; of equal ones the first.
bool PolygonCutter::addFolded(const std::uint32_t* corners, std::size_t count) {
    double least[kMostFolded][kMostFolded] = {};
    std::size_t third[kMostFolded][kMostFolded] = {};
    const auto areaOf = [&](std::size_t i, std::size_t j, std::size_t k) {
        const Vec3d& p = mPoints[corners[i]];
        return cross(mPoints[corners[j]] - p, mPoints[corners[k]] - p);
    };
    for (std::size_t chain = 2; chain < count; ++chain)
        for (std::size_t i = 0; i + chain < count; ++i)
            for (std::size_t j = i + 1, end = i + chain; j < end; ++j) {
                const double area = least[i][j] + least[j][end] + length(areaOf(i, j, end));
                if (j > i + 1 && area >= least[i][end]) continue;
                least[i][end] = area;
                third[i][end] = j;
            }
    double flipped = 0;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, count - 1}};
    while (!open.empty()) {
        const auto [i, end] = open.back();
        open.pop_back();
        if (end < i + 2) continue;
        const std::size_t j = third[i][end];
        if (corners[i] != corners[j] && corners[j] != corners[end] && corners[end] != corners[i])
            mMesh.triangles.push_back({corners[i], corners[j], corners[end]});
        flipped += std::max(0.0, -dot(areaOf(i, j, end), mNormal));
        open.push_back({j, end});
        open.push_back({i, j});
    }
    return flipped <= kFlippedShare * least[0][count - 1];
}

// Scales values to the clipper's grid.
template <typename Assign>
void toGrid(const std::vector<double>& values, Assign&& assign) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const double scale = *high > *low ? double(kPlaneMost) / (*high - *low) : 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        assign(i, std::min(kPlaneMost, std::int64_t(std::llround((values[i] - *low) * scale))));
}

// Fills mRing, counter-clockwise. Returns false if all corners are on a line.
bool PolygonCutter::project(const std::uint32_t* corners, std::size_t count) {
    const Vec3d& start = mPoints[corners[0]];
    Vec3d area, largest;
    double size = 0;
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const Vec3d one = mPoints[corners[i]] - start, other = mPoints[corners[i + 1]] - start;
        const Vec3d part = cross(one, other);
        area = area + part;
        if (dot(part, part) > dot(largest, largest)) largest = part;
        size = std::max({size, dot(one, one), dot(other, other)});
    }
    if (length(largest) <= kNoArea * size) return false;
    // A ring that crosses itself may have no area in all.
    if (length(area) <= kNoArea * size) area = dot(area, largest) < 0 ? -largest : largest;
    mNormal = normalized(area);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(mNormal[i]) < std::abs(mNormal[axis])) axis = i;
    Vec3d unit;
    unit[axis] = 1;
    const Vec3d along = normalized(cross(unit, mNormal)), across = cross(mNormal, along);
    mAlong.resize(count);
    mAcross.resize(count);
    double lowest = 0, highest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d p = mPoints[corners[i]] - start;
        mAlong[i] = dot(p, along);
        mAcross[i] = dot(p, across);
        lowest = std::min(lowest, dot(p, mNormal));
        highest = std::max(highest, dot(p, mNormal));
    }
    mFlat = highest - lowest <= kFlat * std::sqrt(size);
    mRing.resize(count);
    toGrid(mAlong, [this](std::size_t i, std::int64_t value) { mRing[i].x = value; });
    toGrid(mAcross, [this](std::size_t i, std::int64_t value) { mRing[i].y = value; });
    return true;
}

// True if the fan of the first corner covers mRing, without triangles of zero area.
bool PolygonCutter::isConvex() const {
    const std::size_t n = mRing.size();
    const auto at = [&](std::size_t i) { return mRing[i < n ? i : i - n]; };
    std::size_t turns = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const PlanePoint p = at(i), q = at(i + 1), r = at(i + 2);
        if (doubleArea(p, q, r) < 0) return false;
        if (i > 0 && i + 1 < n && doubleArea(mRing[0], p, q) <= 0) return false;
        // More than one turn winds around twice.
        const bool up = q.y > p.y || (q.y == p.y && q.x > p.x),
                   upNext = r.y > q.y || (r.y == q.y && r.x > q.x);
        turns += up != upNext;
    }
    return turns <= 2;
}

}  // namespace

std::size_t appendPolygons(Mesh& mesh, const PolygonList& polygons, const std::vector<Vec3d>& points) {
    PolygonCutter cutter(mesh, points);
    std::size_t at = 0, crossing = 0;
    for (const std::uint32_t count : polygons.sizes) {
        crossing += !cutter.add(polygons.corners.data() + at, count);
        at += count;
    }
    return crossing;
}

}  // namespace vdbsynth
