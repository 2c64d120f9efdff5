#include "libvdbsynth/vdb/convert/far_grid.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

// The voxels at their places plus `by`, whole multiples of 8. The grid's tree is emptied.
void moveVoxels(openvdb::FloatGrid& grid, const openvdb::Coord& by) {
    const Tree::Ptr from = grid.treePtr();
    const Tree::Ptr to = std::make_shared<Tree>(from->background());
    Tree::ValueAllCIter tile = from->cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        if (*tile == from->background() && !tile.isValueOn()) continue;
        openvdb::CoordBBox box = tile.getBoundingBox();
        box.translate(by);
        to->sparseFill(box, *tile, tile.isValueOn());
    }
    std::vector<Leaf*> leaves;
    from->root().stealNodes(leaves);
    for (Leaf* leaf : leaves) {
        leaf->setOrigin(leaf->origin() + by);
        to->addLeaf(leaf);
    }
    grid.setTree(to);
}

}  // namespace

WholeVoxels wholeVoxels(const Vec3d& origin, double voxelSize) {
    WholeVoxels place;
    for (int axis = 0; axis < 3; ++axis) {
        place.voxels[axis] = std::round(origin[axis] / voxelSize / 8) * 8 + 0.0;
        place.rest[axis] = origin[axis] - place.voxels[axis] * voxelSize;
    }
    return place;
}

FloatGridPtr movedBy(const FloatGridPtr& grid, const WholeVoxels& place, const std::string& name,
                     const RunContext& ctx) {
    const Vec3d& v = place.voxels;
    if (v.x == 0 && v.y == 0 && v.z == 0) return grid;
    const IndexBox box = fromBBox(grid->evalActiveVoxelBoundingBox());
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({farthest, std::abs(v[axis] + box.min[axis]), std::abs(v[axis] + box.max[axis])});
    if (farthest < kFarVoxels) {
        moveVoxels(*grid, {int(v.x), int(v.y), int(v.z)});
        return grid;
    }
    const double voxel = voxelSizeOf(*grid);
    grid->transform().postTranslate(toVec(v * voxel));
    message(ctx, MessageLevel::Note,
            name + ": lies " + roundedText(farthest * voxel, 6) + " from zero; the grid's transform keeps " +
                roundedText(v.x * voxel, 12) + "," + roundedText(v.y * voxel, 12) + "," +
                roundedText(v.z * voxel, 12) + " as its offset");
    return grid;
}

FloatGridPtr nearZero(const FloatGridPtr& grid) {
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    if (box.empty()) return grid;
    openvdb::Coord by(0);
    bool far = false;
    for (int axis = 0; axis < 3; ++axis) {
        far = far || box.min()[axis] < -kFarVoxels || box.max()[axis] > kFarVoxels;
        by[axis] = -((box.min()[axis] / 2 + box.max()[axis] / 2) & ~7);
    }
    if (!far) return grid;
    openvdb::FloatGrid::Ptr near = grid->deepCopy();
    moveVoxels(*near, by);
    near->transform().preTranslate(-by.asVec3d());
    return near;
}

void requireVoxelSize(double voxelSize, const std::string& name) {
    constexpr double kSmallest = 1.45e-5;  // its cube is OpenVDB's smallest determinant of a transform
    if (voxelSize >= kSmallest) return;
    throw Error(ErrorCode::Unusable,
                name + ": voxels of " + roundedText(voxelSize, 3) + " are smaller than OpenVDB can hold (" +
                    roundedText(kSmallest, 3) +
                    "); choose a smaller unit with `unitScale`, as 1000000 for metres in micrometres");
}

}  // namespace vdbsynth
