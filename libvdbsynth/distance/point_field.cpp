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
constexpr float kReach = 2.5f;        // spacings from a point within which the points alone decide

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

    // Mean of the distances to the tangent planes of the nearest points, by a Gaussian of their distances
    // [kolluri2008, Eq. 2].
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
        double sum = 0, total = 0;
        for (std::size_t k = 0; k < found; ++k) {
            // Relative to the nearest, so that far from all the nearest still counts.
            const double weight = exponential(-double(squared[k] - squared[0]) / double(spacing * spacing));
            sum += weight * double(dot(mCloud.normals[numbers[k]], place - mCloud.points[numbers[k]]));
            total += weight;
        }
        const float plane = float(sum / total);
        // A shell ends a spacing beyond its last points.
        const float distance =
            mThickness > 0 ? std::max(std::abs(plane), nearest - spacing) - mThickness / 2 : plane;
        return std::clamp(distance, -mLimit, mLimit);
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
