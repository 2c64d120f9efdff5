#include "libvdbsynth/distance/winding_number.h"

#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kFar = 3;  // radii from a cluster at which its dipole stands for it
constexpr std::uint32_t kLeafFaces = 8;

// A sum of angles, each in (-pi, pi], kept as the product of complex numbers with these arguments and the
// whole turns that the product's own argument lost: one arc tangent for all of them.
class AngleSum {
public:
    void add(double y, double x) {
        const double re = mRe * x - mIm * y, im = mRe * y + mIm * x;
        // Two angles of one sign lose a turn where their sum leaves (-pi, pi].
        if (mIm >= 0 && y >= 0 && (im < 0 || (im == 0 && re > 0 && mRe < 0))) ++mTurns;
        if (mIm < 0 && y < 0 && im >= 0) --mTurns;
        const double size = std::abs(re) + std::abs(im);
        mRe = re / size;
        mIm = im / size;
    }
    double turns() const { return arcTangent(mIm, mRe) / (2 * kPi) + mTurns; }

private:
    double mRe = 1, mIm = 0;
    int mTurns = 0;
};

// Adds half the solid angle of a triangle [vanoosterom1983, Eq. 8], which as turns is its share of 4 pi.
void addSolidAngle(AngleSum& sum, const Vec3d& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3d u = cast<double>(a) - p, v = cast<double>(b) - p, w = cast<double>(c) - p;
    const double lu = length(u), lv = length(v), lw = length(w);
    const double above = dot(u, cross(v, w));
    const double below = lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv;
    const double size = std::abs(above) + std::abs(below);
    if (size > 0 && std::isfinite(size)) sum.add(above / size, below / size);
}

// Solid angle of a small area at a place, over 4 pi.
double dipole(const Vec3d& p, const Vec3f& place, const Vec3f& area) {
    const Vec3d towards = cast<double>(place) - p;
    const double squared = dot(towards, towards);
    return squared > 0 ? dot(towards, cast<double>(area)) / (4 * kPi * squared * std::sqrt(squared)) : 0;
}

}  // namespace

WindingNumber::WindingNumber(const Mesh& mesh, const RunContext& ctx) {
    for (const Triangle& t : triangulated(mesh))
        mFaces.push_back({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
    mNodes.reserve(mFaces.size() / 2 + 1);
    throwIfCancelled(ctx);
    if (!mFaces.empty()) build(0, std::uint32_t(mFaces.size()));
}

WindingNumber::WindingNumber(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                             const std::vector<float>& areas, const RunContext& ctx)
    : mPoints(true) {
    for (std::size_t i = 0; i < points.size(); ++i)
        mFaces.push_back({points[i], normals[i] * areas[i], points[i]});
    mNodes.reserve(mFaces.size() / 2 + 1);
    throwIfCancelled(ctx);
    if (!mFaces.empty()) build(0, std::uint32_t(mFaces.size()));
}

WindingNumber::Moments WindingNumber::momentsOf(const Face& face) const {
    const Vec3d a = cast<double>(face.a), b = cast<double>(face.b), c = cast<double>(face.c);
    if (mPoints) return {a, b};
    return {(a + b + c) * (1.0 / 3), cross(b - a, c - a) * 0.5};
}

std::uint32_t WindingNumber::build(std::uint32_t first, std::uint32_t count) {
    const std::uint32_t index = std::uint32_t(mNodes.size());
    mNodes.emplace_back();
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300}, weighted, total;
    double area = 0;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const auto [middle, normal] = momentsOf(mFaces[i]);
        weighted = weighted + middle * length(normal);
        area += length(normal);
        total = total + normal;
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], middle[axis]);
            high[axis] = std::max(high[axis], middle[axis]);
        }
    }
    const Vec3d centre = area > 0 ? weighted * (1 / area) : (low + high) * 0.5;
    double radius = 0;
    for (std::uint32_t i = first; i < first + count; ++i)
        for (const Vec3f& corner : {mFaces[i].a, mPoints ? mFaces[i].a : mFaces[i].b, mFaces[i].c})
            radius = std::max(radius, length(cast<double>(corner) - centre));
    std::uint32_t right = 0;
    if (count > kLeafFaces) {
        int axis = 0;
        for (int other = 1; other < 3; ++other)
            if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
        const auto middle = mFaces.begin() + first + count / 2;
        std::nth_element(mFaces.begin() + first, middle, mFaces.begin() + first + count,
                         [this, axis](const Face& x, const Face& y) {
                             if (mPoints) return x.a[axis] < y.a[axis];
                             return x.a[axis] + x.b[axis] + x.c[axis] < y.a[axis] + y.b[axis] + y.c[axis];
                         });
        build(first, count / 2);
        right = build(first + count / 2, count - count / 2);
    }
    mNodes[index] = {cast<float>(centre), float(radius), cast<float>(total), first, count, right};
    return index;
}

double WindingNumber::at(const Vec3d& point) const {
    double sum = 0;
    AngleSum near;
    std::array<std::uint32_t, 128> stack;  // as deep as two of a halving tree of 2^32 faces
    std::size_t depth = 0;
    if (!mNodes.empty()) stack[depth++] = 0;
    while (depth > 0) {
        const std::uint32_t index = stack[--depth];
        const Node& node = mNodes[index];
        const Vec3d towards = cast<double>(node.centre) - point;
        const double squared = dot(towards, towards), reach = double(kFar) * double(node.radius);
        if (squared > reach * reach) {
            sum += dipole(point, node.centre, node.dipole);
        } else if (node.right == 0) {
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (mPoints)
                    sum += dipole(point, mFaces[i].a, mFaces[i].b);
                else
                    addSolidAngle(near, point, mFaces[i].a, mFaces[i].b, mFaces[i].c);
        } else {
            stack[depth++] = node.right;
            stack[depth++] = index + 1;
        }
    }
    return sum + near.turns();
}

double solidShare(const Mesh& mesh, const WindingNumber& winding) {
    const std::vector<Triangle> triangles = triangulated(mesh);
    const std::size_t step = std::max<std::size_t>(1, triangles.size() / 4096);
    double solid = 0, all = 0;
    for (std::size_t i = 0; i < triangles.size(); i += step) {
        const Vec3d a = cast<double>(mesh.points[triangles[i][0]]),
                    b = cast<double>(mesh.points[triangles[i][1]]),
                    c = cast<double>(mesh.points[triangles[i][2]]);
        const Vec3d normal = cross(b - a, c - a) * 0.5, middle = (a + b + c) * (1.0 / 3);
        const double area = length(normal);
        if (!(area > 0)) continue;
        const Vec3d off = normal * (1e-3 / std::sqrt(area));
        const double mean = (winding.at(middle + off) + winding.at(middle - off)) / 2;
        solid += mean >= 0.2 ? area : 0;
        all += area;
    }
    return all > 0 ? solid / all : 0;
}

}  // namespace vdbsynth
