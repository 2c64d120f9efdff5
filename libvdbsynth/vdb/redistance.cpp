#include "libvdbsynth/vdb/redistance.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/rebuild_band.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

// Reads parts of a grid as they are, in its own unit.
FieldReader readerOf(const openvdb::FloatGrid& field, const RunContext& ctx) {
    return [&field, &ctx](const IndexBox& box) {
        auto part = std::make_shared<BrickField>(
            gatherBricks(field, box, 1.f, std::numeric_limits<float>::infinity(), ctx));
        part->translate(box.min);
        return part;
    };
}

IndexBox activeBox(const openvdb::FloatGrid& field, const std::string& what) {
    const openvdb::CoordBBox active = field.evalActiveVoxelBoundingBox();
    if (active.empty()) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    return fromBBox(active);
}

// A level set on the lattice of `like` from the parts that `rebuild` hands out.
FloatGridPtr fromParts(const openvdb::FloatGrid& like, float halfWidth, const std::string& what,
                       const RunContext& ctx, const std::function<void(const PartTaker&)>& rebuild) {
    const float voxel = float(voxelSizeOf(like));
    const FloatGridPtr grid = openvdb::FloatGrid::create(halfWidth * voxel);
    rebuild([&](const BrickField& part) {
        moveInto(*grid, *scatterBricks(part, {0, 0, 0}, voxel, halfWidth, ctx));
    });
    if (grid->activeVoxelCount() == 0) throw Error(ErrorCode::EmptyInput, what + " has no surface");
    grid->setTransform(like.transform().copy());
    grid->setName(kSurfaceName);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

// The box of the lattice that a box of the field lies in.
IndexBox imageOf(const openvdb::FloatGrid& field, const openvdb::FloatGrid& lattice, const IndexBox& box) {
    const openvdb::BBoxd world = field.transform().indexToWorld(
        openvdb::BBoxd(openvdb::Vec3d(toCoord(box.min).asVec3d()), toCoord(box.max).asVec3d()));
    const openvdb::BBoxd image = lattice.transform().worldToIndex(world);
    return fromBBox({openvdb::Coord::floor(image.min()), openvdb::Coord::ceil(image.max())});
}

// From the index space of one grid to that of another.
Affine between(const openvdb::FloatGrid& from, const openvdb::FloatGrid& to) {
    const auto matrixOf = [](const openvdb::FloatGrid& grid) {
        return grid.transform().baseMap()->getAffineMap()->getMat4();
    };
    const openvdb::Mat4d matrix = matrixOf(from) * matrixOf(to).inverse();  // row vectors: from, then to
    Affine map;
    std::copy_n(matrix.asPointer(), map.size(), map.begin());
    return map;
}

}  // namespace

FloatGridPtr rebuildLevelSet(const openvdb::FloatGrid& field, float halfWidth, const std::string& what,
                             const RunContext& ctx) {
    const IndexBox box = activeBox(field, what).expanded(int(std::ceil(halfWidth)) + 1);
    RebuildOptions options;
    options.halfWidth = halfWidth;
    options.voxelSize = float(voxelSizeOf(field));
    // Level sets were always measured so; other fields, and those in parts, from inward faces.
    if (field.getGridClass() == openvdb::GRID_LEVEL_SET) options.facing = Facing::Outward;
    return fromParts(field, halfWidth, what, ctx, [&](const PartTaker& take) {
        rebuildBand(readerOf(field, ctx), box, options, take, ctx);
    });
}

FloatGridPtr resampleLevelSet(const openvdb::FloatGrid& field, const openvdb::FloatGrid& lattice,
                              float halfWidth, const std::string& what, const RunContext& ctx) {
    const IndexBox box = activeBox(field, what).expanded(1);
    RebuildOptions options;
    options.halfWidth = halfWidth;
    options.voxelSize = float(voxelSizeOf(lattice));
    options.keepDistances = field.getGridClass() == openvdb::GRID_LEVEL_SET;
    options.band = options.keepDistances ? field.background() / options.voxelSize : halfWidth;
    return fromParts(lattice, halfWidth, what, ctx, [&](const PartTaker& take) {
        resampleBand(readerOf(field, ctx), {between(lattice, field), between(field, lattice)},
                     imageOf(field, lattice, box).expanded(int(std::ceil(halfWidth)) + 1), options, take,
                     ctx);
    });
}

}  // namespace vdbsynth
