#include "libvdbsynth/vdb/mask.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/wall.h"

#include <cmath>

namespace vdbsynth {
namespace {

openvdb::BoolGrid::Ptr emptyMask(const openvdb::math::Transform::Ptr& transform) {
    auto mask = emptyGrid<openvdb::BoolGrid>();
    mask->setName("mask");
    mask->setTransform(transform);
    return mask;
}

void requireVoxelSize(double voxelSize) {
    requireOption(voxelSize > 0 && voxelSize < 1e30, "voxelSize", roundedText(voxelSize, 6),
                  "above 0 (world)");
}

}  // namespace

void requireMaskFor(const openvdb::GridBase& grid, const openvdb::FloatGrid& like) {
    if (!(grid.transform() == like.transform()))
        throw Error(ErrorCode::ShapeMismatch,
                    "mask \"" + grid.getName() + "\": its voxels (size " +
                        std::to_string(grid.voxelSize()[0]) + ") are not those of the model (size " +
                        std::to_string(like.voxelSize()[0]) + "); make it with the same `voxelSize`");
}

BrickField gatherMask(const openvdb::GridBase& grid, const IndexBox& box, const openvdb::FloatGrid& like,
                      const RunContext& ctx) {
    requireMaskFor(grid, like);
    BrickField field;
    if (grid.apply<MaskGrids>([&](const auto& typed) {
            field = BrickField::generate(
                IndexBox::fromSize(box.size()), ctx, [&](const IndexBox& brick, float* samples) {
                    const auto accessor = typed.getConstAccessor();
                    forEachVoxel(brick, [&](const Index3& p) {
                        *samples++ = accessor.isValueOn(toCoord(p + box.min)) ? 1.f : 0.f;
                    });
                });
        }))
        return field;
    throw Error(ErrorCode::BadData, "mask \"" + grid.getName() + "\": a grid of " + grid.valueType() +
                                        " cannot be a mask; bool, mask, int32 or float can");
}

IndexBox activeBox(const openvdb::GridBase& grid) {
    if (grid.activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, "mask \"" + grid.getName() + "\": has no active voxels");
    return fromBBox(grid.evalActiveVoxelBoundingBox());
}

GridPtr boxMask(const IndexBox& box, double voxelSize) {
    requireBox(box, "box");
    requireVoxelSize(voxelSize);
    auto mask = emptyMask(openvdb::math::Transform::createLinearTransform(voxelSize));
    mask->fill(toBBox(box), true, true);
    return mask;
}

GridPtr ballMask(const Vec3d& centre, double radius, double voxelSize) {
    requireVoxelSize(voxelSize);
    requireOption(radius > 0 && radius < 1e4 * voxelSize, "radius", roundedText(radius, 6),
                  "above 0 (world) and under ten thousand voxels");
    auto mask = emptyMask(openvdb::math::Transform::createLinearTransform(voxelSize));
    auto accessor = mask->getAccessor();
    const Vec3d c = centre * (1 / voxelSize);
    const double r = radius / voxelSize;
    IndexBox around;
    for (int axis = 0; axis < 3; ++axis) {
        around.min[axis] = int(std::ceil(c[axis] - r));
        around.max[axis] = int(std::floor(c[axis] + r));
    }
    forEachVoxel(around, [&](const Index3& p) {
        if (length(Vec3d{double(p.x), double(p.y), double(p.z)} - c) <= r)
            accessor.setValueOn(toCoord(p), true);
    });
    return mask;
}

GridPtr insideMask(const openvdb::FloatGrid& levelSet) {
    auto mask = emptyMask(levelSet.transform().copy());
    for (auto it = levelSet.cbeginValueAll(); it; ++it) {
        if (*it >= 0) continue;
        if (it.isVoxelValue())
            mask->tree().setValueOn(it.getCoord(), true);
        else
            mask->fill(it.getBoundingBox(), true, true);
    }
    return mask;
}

GridPtr rangeMask(const openvdb::FloatGrid& grid, double minimum, double maximum) {
    requireOption(minimum <= maximum, "minimum", roundedText(minimum, 6),
                  "at most `maximum` " + roundedText(maximum, 6));
    auto mask = emptyMask(grid.transform().copy());
    for (auto it = grid.cbeginValueOn(); it; ++it) {
        if (double(*it) < minimum || double(*it) > maximum) continue;
        if (it.isVoxelValue())
            mask->tree().setValueOn(it.getCoord(), true);
        else
            mask->fill(it.getBoundingBox(), true, true);
    }
    return mask;
}

}  // namespace vdbsynth
