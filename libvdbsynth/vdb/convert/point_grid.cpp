#include "libvdbsynth/vdb/convert/point_grid.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>

#include <cmath>

namespace vdbsynth {
namespace {

namespace points = openvdb::points;
using IndexGrid = openvdb::tools::PointIndexGrid;

template <typename Value>
void addAttribute(points::PointDataGrid& grid, const IndexGrid& index, const std::string& name,
                  const std::vector<Value>& values) {
    points::appendAttribute<Value>(grid.tree(), name);
    const points::PointAttributeVector<Value> wrapped(values);
    points::populateAttribute(grid.tree(), index.tree(), name, wrapped);
}

std::vector<openvdb::Vec3f> asVectors(const Attribute& attribute) {
    std::vector<openvdb::Vec3f> vectors(attribute.values.size() / attribute.width, openvdb::Vec3f(0.f));
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (std::size_t c = 0; c < attribute.width; ++c)
            vectors[i][int(c)] = attribute.values[i * attribute.width + c];
    return vectors;
}

// Voxels are numbered by 32 bits.
void requireRange(const PointCloud& cloud, double voxelSize) {
    constexpr double kFarthest = 1 << 30;
    for (const Vec3f& p : cloud.points)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(cloud.origin[axis] + double(p[axis])) < kFarthest * voxelSize))
                throw Error(ErrorCode::Unusable, "a point lies over 2^30 voxels of " +
                                                     roundedText(voxelSize, 3) + " from the origin");
}

}  // namespace

GridPtr pointGrid(const PointCloud& cloud, double voxelSize, const RunContext& ctx) {
    requireOption(voxelSize > 0 && voxelSize < 1e30, "voxelSize", roundedText(voxelSize, 6),
                  "above 0 (world)");
    if (cloud.points.empty()) throw Error(ErrorCode::EmptyInput, "there are no points to write");
    requireRange(cloud, voxelSize);
    throwIfCancelled(ctx);
    openvdb::initialize();
    return behindWall(ErrorCode::Unusable, "the points", [&]() -> GridPtr {
        std::vector<openvdb::Vec3d> positions;
        positions.reserve(cloud.points.size());
        for (const Vec3f& p : cloud.points) positions.push_back(toVec(cloud.origin + cast<double>(p)));
        const auto transform = openvdb::math::Transform::createLinearTransform(voxelSize);
        const points::PointAttributeVector<openvdb::Vec3d> wrapped(positions);
        const IndexGrid::Ptr index = openvdb::tools::createPointIndexGrid<IndexGrid>(wrapped, *transform);
        const points::PointDataGrid::Ptr grid =
            points::createPointDataGrid<points::NullCodec, points::PointDataGrid>(*index, wrapped,
                                                                                  *transform);
        grid->setName("points");
        if (cloud.normals.size() == cloud.points.size()) {
            std::vector<openvdb::Vec3f> normals;
            for (const Vec3f& n : cloud.normals) normals.emplace_back(n.x, n.y, n.z);
            addAttribute(*grid, *index, "N", normals);
        }
        for (const Attribute& attribute : cloud.attributes) {
            if (attribute.width == 1)
                addAttribute(*grid, *index, attribute.name, attribute.values);
            else
                addAttribute(*grid, *index, attribute.name, asVectors(attribute));
        }
        return grid;
    });
}

}  // namespace vdbsynth
