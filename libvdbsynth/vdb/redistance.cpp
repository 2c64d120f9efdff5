#include "libvdbsynth/vdb/redistance.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/rebuild_band.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"

#include <openvdb/openvdb.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

namespace vdbsynth {
namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

// Moves the leaves and constant regions of a part, which consists of whole leaves, into the result.
void moveInto(openvdb::FloatGrid& to, openvdb::FloatGrid& from) {
    auto tile = from.tree().cbeginValueOff();
    tile.setMaxDepth(Tree::ValueOffCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile)
        if (*tile < 0) to.tree().addTile(tile.getLevel(), tile.getCoord(), *tile, false);
    std::vector<Leaf*> leaves;
    from.tree().stealNodes(leaves, from.background(), false);
    for (Leaf* leaf : leaves) to.tree().addLeaf(leaf);
}

}  // namespace

FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx) {
    const openvdb::CoordBBox active = field.evalActiveVoxelBoundingBox();
    if (active.empty()) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    RebuildOptions options;
    options.halfWidth = halfWidth;
    options.voxelSize = float(voxelSizeOf(field));
    // Level sets were always measured so; other fields, and those in parts, from inward faces.
    if (field.getGridClass() == openvdb::GRID_LEVEL_SET) options.facing = Facing::Outward;
    const FieldReader read = [&](const IndexBox& box) {
        auto part = std::make_shared<BrickField>(
            gatherBricks(field, box, 1.f, std::numeric_limits<float>::infinity(), ctx));
        part->translate(box.min);
        return part;
    };
    const float voxel = options.voxelSize;
    const FloatGridPtr grid = openvdb::FloatGrid::create(halfWidth * voxel);
    rebuildBand(
        read, fromBBox(active).expanded(int(std::ceil(halfWidth)) + 1), options,
        [&](const BrickField& part) {
            moveInto(*grid, *scatterBricks(part, {0, 0, 0}, voxel, halfWidth, ctx));
        },
        ctx);
    if (grid->activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    grid->setTransform(field.transform().copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

}  // namespace vdbsynth
