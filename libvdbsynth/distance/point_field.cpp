#include "libvdbsynth/distance/point_field.h"

#include "libvdbsynth/distance/winding_field.h"
#include "libvdbsynth/distance/winding_number.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = 8;
constexpr std::size_t kNearest = 12;  // points that a value is made of
constexpr double kOpposite = -0.25;   // cosine between the normals of two sides of a wall
// Variance of normals about a fitted sphere's from which on it loses its share, and at which it has none.
// Noise has up to 0.05, a right angle from 0.2 on (chosen on a CAD part, scans and smooth models with noise).
constexpr double kSmooth = 0.05, kCrease = 0.4;
// Spacings from the nearest point, up to which a sphere has its share, and from which on it has none.
constexpr double kNear = 1.25, kAfar = 2;
constexpr float kReach = 2.5f;  // spacings from a point within which the points alone decide

// A point near a voxel, relative to it.
struct NearPoint {
    Vec3d p, normal;
    double weight = 0;
};

// Mean of the distances to the tangent planes [kolluri2008, Eq. 2].
double planesDistance(const NearPoint* points, std::size_t count) {
    double sum = 0, total = 0;
    for (std::size_t k = 0; k < count; ++k) {
        sum -= points[k].weight * dot(points[k].normal, points[k].p);
        total += points[k].weight;
    }
    return sum / total;
}

// The algebraic sphere u(y) = constant + linear . y + square |y|^2 fitted to points and normals
// [guennebaud2008, Eqs. 4-6], how far it is away, and how much better than planes it explains the points.
struct FittedSphere {
    double distance = 0;
    double share = 0;  // 0..1, that it should have in the value beside the planes
};

FittedSphere fittedSphere(const NearPoint* points, std::size_t count) {
    double weight = 0, np = 0, pp = 0;
    Vec3d sumP, sumN;
    for (std::size_t k = 0; k < count; ++k) {
        const NearPoint& near = points[k];
        weight += near.weight;
        sumP = sumP + near.p * near.weight;
        sumN = sumN + near.normal * near.weight;
        np += near.weight * dot(near.normal, near.p);
        pp += near.weight * dot(near.p, near.p);
    }
    const double spread = pp - dot(sumP, sumP) / weight;
    if (!(spread > 1e-9 * pp) || !(dot(sumN, sumN) > 0)) return {};
    const double square = 0.5 * (np - dot(sumP, sumN) / weight) / spread;
    const Vec3d linear = (sumN - sumP * (2 * square)) * (1 / weight), mean = sumP * (1 / weight);
    const double constant = -(dot(sumP, linear) + square * pp) / weight;
    const double squaredGradient = dot(linear, linear) - 4 * constant * square;
    if (!(squaredGradient > 0)) return {};
    double ofSphere = 0, ofPlane = 0, ofNormals = 0;
    const Vec3d up = normalized(sumN);
    for (std::size_t k = 0; k < count; ++k) {
        const NearPoint& near = points[k];
        const double u = constant + dot(linear, near.p) + square * dot(near.p, near.p),
                     height = dot(up, near.p - mean);
        const Vec3d turn = near.normal - linear - near.p * (2 * square);
        ofSphere += near.weight * u * u / squaredGradient;
        ofPlane += near.weight * height * height;
        ofNormals += near.weight * dot(turn, turn) / weight;
    }
    FittedSphere sphere;
    sphere.distance = 2 * constant / (length(linear) + std::sqrt(squaredGradient));
    // At creases normals vary more than on any sphere.
    const double crease = std::clamp((ofNormals - kSmooth) / (kCrease - kSmooth), 0.0, 1.0);
    if (ofPlane > 0) sphere.share = ofPlane / (ofPlane + ofSphere) * (1 - crease * crease * (3 - 2 * crease));
    return sphere;
}

class PointField {
public:
    PointField(const PointCloud& indexCloud, const PointFieldOptions& options, const RunContext& ctx)
        : mCloud(indexCloud),
          mThickness(options.thickness),
          mLimit(options.limit),
          mContext(ctx),
          mTree(indexCloud.points),
          mSpacing(pointSpacing(indexCloud, ctx)),
          mWinding(indexCloud.points, indexCloud.normals, areas(), ctx) {}

    // Share of the points that clearly have an inside and an outside, as solidShare of faces.
    double solidShare() const {
        const std::size_t step = std::max<std::size_t>(1, mCloud.points.size() / 2048);
        std::size_t solid = 0, all = 0;
        for (std::size_t i = 0; i < mCloud.points.size(); i += step, ++all) {
            const Vec3d p = cast<double>(mCloud.points[i]),
                        off = cast<double>(mCloud.normals[i]) * (2 * double(mSpacing[i]));
            solid += mWinding.at(p + off) + mWinding.at(p - off) >= 0.4 ? 1 : 0;
        }
        return all > 0 ? double(solid) / double(all) : 0;
    }

    BrickField run() {
        IndexBox box{{1 << 28, 1 << 28, 1 << 28}, {-(1 << 28), -(1 << 28), -(1 << 28)}};
        mLeaves.resize(4);
        for (std::size_t i = 0; i < mCloud.points.size(); ++i) {
            const float reach = std::max(mLimit + 1, kReach * mSpacing[i]) + mThickness / 2;
            IndexBox near;
            for (int axis = 0; axis < 3; ++axis) {
                near.min[axis] = int(std::floor((mCloud.points[i][axis] - reach) / kSide));
                near.max[axis] = int(std::floor((mCloud.points[i][axis] + reach) / kSide));
                box.min[axis] = std::min(box.min[axis], near.min[axis] * kSide);
                box.max[axis] = std::max(box.max[axis], near.max[axis] * kSide + kSide - 1);
            }
            forEachVoxel(near, [&](const Index3& leaf) {
                for (int level = 0; level < 4; ++level)
                    mLeaves[std::size_t(level)].insert({leaf.x >> level, leaf.y >> level, leaf.z >> level});
            });
        }
        WindingFieldSource source;
        source.hasSurface = [this](const Index3& corner, int side) {
            int level = 0;
            while (kSide << level < side) ++level;
            const int shift = 3 + level;
            return mLeaves[std::size_t(level)].count(
                       {corner.x >> shift, corner.y >> shift, corner.z >> shift}) > 0;
        };
        source.winding = [this](const Index3& p) {
            return mThickness > 0 ? 0.0 : mWinding.at({double(p.x), double(p.y), double(p.z)});
        };
        source.fill = [this](const Index3& corner, float* values) {
            for (int i = 0; i < kSide * kSide * kSide; ++i)
                values[i] = value(corner + Index3{i >> 6, (i >> 3) & 7, i & 7});
        };
        return windingField(box, mLimit, source, mContext);
    }

private:
    struct LessIndex {
        bool operator()(const Index3& a, const Index3& b) const { return a < b; }
    };

    std::vector<float> areas() const {
        std::vector<float> areas;
        // On a square lattice 1.5 squares of the spacing, on a hexagonal one 1.73, at random places 1.8.
        for (float spacing : mSpacing) areas.push_back(1.65f * spacing * spacing);
        return areas;
    }

    float value(const Index3& voxel) const {
        std::uint32_t numbers[kNearest];
        float squared[kNearest];
        const Vec3f place{float(voxel.x), float(voxel.y), float(voxel.z)};
        const std::size_t found = mTree.nearest(place, kNearest, numbers, squared);
        const float spacing = std::max(mSpacing[numbers[0]], 0.5f), nearest = std::sqrt(squared[0]);
        if (nearest > kReach * spacing) {
            if (mThickness > 0) return std::min(nearest - mThickness / 2, mLimit);
            const double winding = mWinding.at({double(place.x), double(place.y), double(place.z)});
            const float distance = std::min({nearest, openingDistance(winding, mLimit)});
            return winding > 0.5 ? -distance : distance;
        }
        const float surface = float(surfaceDistance(place, numbers, squared, found, spacing));
        // A shell ends a spacing beyond its last points.
        const float distance =
            mThickness > 0 ? std::max(std::abs(surface), nearest - spacing) - mThickness / 2 : surface;
        return std::clamp(distance, -mLimit, mLimit);
    }

    // Of the nearest points, weighted by a Gaussian of their distances.
    double surfaceDistance(const Vec3f& place, const std::uint32_t* numbers, const float* squared,
                           std::size_t found, float spacing) const {
        NearPoint all[kNearest], sheet[kNearest];
        std::size_t ofSheet = 0;
        for (std::size_t k = 0; k < found; ++k) {
            // Relative to the nearest, so that far from all the nearest still counts.
            all[k].weight = exponential(-double(squared[k] - squared[0]) / double(spacing * spacing));
            all[k].p = cast<double>(mCloud.points[numbers[k]] - place);
            all[k].normal = cast<double>(mCloud.normals[numbers[k]]);
            // No sphere goes through two sides of a thin wall.
            if (dot(all[k].normal, all[0].normal) > kOpposite) sheet[ofSheet++] = all[k];
        }
        // From afar a few points with noise extrapolate to any sphere.
        const double away = std::sqrt(double(squared[0])) / double(mSpacing[numbers[0]]);
        const double near = std::clamp((kAfar - away) / (kAfar - kNear), 0.0, 1.0);
        if (near <= 0) return planesDistance(all, found);
        const FittedSphere sphere = fittedSphere(sheet, ofSheet);
        const double share = near * sphere.share;
        return share * sphere.distance + (1 - share) * planesDistance(all, found);
    }

    const PointCloud& mCloud;
    float mThickness, mLimit;
    const RunContext& mContext;
    PointNeighbours mTree;
    std::vector<float> mSpacing;
    WindingNumber mWinding;
    std::vector<std::set<Index3, LessIndex>> mLeaves;  // by level: cubes of 8, 16, 32, 64 voxels near points
};

}  // namespace

PointSolid pointField(const PointCloud& cloud, const PointFieldOptions& options, const RunContext& ctx) {
    PointField field(cloud, options, ctx);
    PointSolid solid;
    if (!(options.thickness > 0)) solid.solidShare = field.solidShare();
    solid.field = field.run();
    return solid;
}

}  // namespace vdbsynth
