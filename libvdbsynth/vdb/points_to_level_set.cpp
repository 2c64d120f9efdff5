// Solids from oriented points: near them moving least squares, elsewhere the winding number of their areas.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/geometry/winding_number.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/mesh_conversion.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/winding_field_steps.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kSide = 8;
constexpr std::size_t kNearest = 12;  // points that a value is made of
constexpr float kReach = 2.5f;        // spacings from a point within which the points alone decide

class PointField {
public:
    // `thickness` over 0 [voxels]: a shell.
    PointField(const PointCloud& indexCloud, float thickness, const RunContext& ctx)
        : mCloud(indexCloud),
          mThickness(thickness),
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

    FloatGridPtr run() {
        IndexBox box{{1 << 28, 1 << 28, 1 << 28}, {-(1 << 28), -(1 << 28), -(1 << 28)}};
        mLeaves.resize(4);
        for (std::size_t i = 0; i < mCloud.points.size(); ++i) {
            const float reach = std::max(kHalfWidth + 1, kReach * mSpacing[i]) + mThickness / 2;
            IndexBox near;
            for (int axis = 0; axis < 3; ++axis) {
                near.min[axis] = int(std::floor((mCloud.points[i][axis] - reach) / kSide));
                near.max[axis] = int(std::floor((mCloud.points[i][axis] + reach) / kSide));
                box.min[axis] = std::min(box.min[axis], near.min[axis] * kSide);
                box.max[axis] = std::max(box.max[axis], near.max[axis] * kSide + kSide - 1);
            }
            for (int x = near.min.x; x <= near.max.x; ++x)
                for (int y = near.min.y; y <= near.max.y; ++y)
                    for (int z = near.min.z; z <= near.max.z; ++z)
                        for (int level = 0; level < 4; ++level)
                            mLeaves[std::size_t(level)].insert({x >> level, y >> level, z >> level});
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
        return buildWindingField(box, source, mContext);
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
            if (mThickness > 0) return std::min(nearest - mThickness / 2, kHalfWidth);
            const double winding = mWinding.at({double(place.x), double(place.y), double(place.z)});
            const float distance = std::min({nearest, kHalfWidth, openingDistance(winding)});
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
        return std::clamp(distance, -kHalfWidth, kHalfWidth);
    }

    const PointCloud& mCloud;
    float mThickness;
    const RunContext& mContext;
    PointNeighbours mTree;
    std::vector<float> mSpacing;
    WindingNumber mWinding;
    std::vector<std::set<Index3, LessIndex>> mLeaves;  // by level: cubes of 8, 16, 32, 64 voxels near points
};

}  // namespace

FloatGridPtr pointsToSolid(const PointCloud& cloud, double voxelSize, double halfWidth,
                           const std::string& name, const SolidOptions& options, const RunContext& ctx) {
    requireOption(std::isfinite(voxelSize) && voxelSize > 0, "voxelSize", std::to_string(voxelSize),
                  "above 0");
    requireOption(halfWidth >= 1.5 && halfWidth <= 1000, "halfWidth", std::to_string(halfWidth),
                  "from 1.5 to 1000 voxels");
    validate(options);
    const bool shell = options.open == OpenMesh::Shell;
    requireOption(!shell || (std::isfinite(options.thickness) && options.thickness >= voxelSize), "thickness",
                  std::to_string(options.thickness),
                  "at least a voxel, which is " + std::to_string(voxelSize));
    PointCloud index = cloud;
    const std::size_t outliers = dropOutliers(index, ctx);
    if (outliers > 0)
        message(ctx, MessageLevel::Warning,
                name + ": " + std::to_string(outliers) + " outliers of " +
                    std::to_string(cloud.points.size()) + " points left out");
    if (index.points.size() < 8)
        throw Error(ErrorCode::Unusable, name + ": " + std::to_string(index.points.size()) +
                                             " points in different places make no surface; 8 or more do");
    if (index.normals.empty()) {
        message(ctx, MessageLevel::Note, name + ": no normals; estimated and turned to agree");
        estimateNormals(index, ctx);
    }
    for (Vec3f& p : index.points) p = cast<float>(cast<double>(p) * (1 / voxelSize));
    double area = 0;
    for (float spacing : pointSpacing(index, ctx)) area += double(spacing) * double(spacing);
    requireMemory(ctx, area * 2 * halfWidth * 60,
                  name + ": a level set at voxel size " + std::to_string(voxelSize),
                  "use a larger `voxelSize` or a smaller `resolution`");
    Stage stage(ctx, "points to level set", 1);
    PointField points(index, shell ? float(options.thickness / voxelSize) : 0, ctx);
    const double share = shell ? 1 : points.solidShare();
    if (share < 0.5)
        message(
            ctx, MessageLevel::Warning,
            name + ": " + std::to_string(int(100 * (1 - share))) +
                " % of the points bound nothing, as of a scan from one side; `open` shell and a `thickness` "
                "makes a shell of them");
    const FloatGridPtr field = points.run();
    stage.advance();
    field->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    return rebuildLevelSet(*field, float(halfWidth), name, ctx);
}

}  // namespace vdbsynth
