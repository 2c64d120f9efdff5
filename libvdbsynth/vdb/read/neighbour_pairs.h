#pragma once
#include "libvdbsynth/vdb/grid_kinds.h"

// Pairs of neighbouring voxels of which at least one is inactive, as signs and bands are checked by them.
namespace vdbsynth {

/// Two voxels that share a face, or two squares of such: `span` voxels a side, from `a` and `b` on.
struct VoxelPair {
    openvdb::Coord a, b;
    float valueA = 0, valueB = 0;
    bool activeA = false, activeB = false;
    int span = 1;
};

/// Pairs of which one voxel lies in `leaf`: each pair of voxels in leaves comes once, from the lower one.
/// @param accessor  of the leaf's tree
template <typename Take>
void forEachPairOfLeaf(const openvdb::FloatTree::LeafNodeType& leaf,
                       const openvdb::FloatGrid::ConstAccessor& accessor, Take&& take) {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    constexpr int kSteps[3] = {Leaf::DIM * Leaf::DIM, Leaf::DIM, 1};
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
        const bool active = leaf.isValueOn(n);
        VoxelPair pair;
        pair.a = leaf.offsetToGlobalCoord(n);
        pair.valueA = leaf.getValue(n);
        pair.activeA = active;
        for (int axis = 0; axis < 3; ++axis)
            for (const int direction : {1, -1}) {
                const int at = pair.a[axis] & int(Leaf::DIM - 1);
                const bool within = direction > 0 ? at < int(Leaf::DIM) - 1 : at > 0;
                if (within && direction < 0) continue;
                pair.b = pair.a;
                pair.b[axis] += direction;
                if (within) {
                    const openvdb::Index m = n + openvdb::Index(kSteps[axis]);
                    if (active && leaf.isValueOn(m)) continue;
                    pair.valueB = leaf.getValue(m);
                    pair.activeB = leaf.isValueOn(m);
                } else {
                    if (direction < 0 && accessor.probeConstLeaf(pair.b)) continue;
                    pair.activeB = accessor.probeValue(pair.b, pair.valueB);
                    if (active && pair.activeB) continue;
                }
                take(pair);
            }
    }
}

/// Pairs of constant regions, or of one and the background, in squares as large as the tree has them. A pair
/// of two regions of one size comes twice.
template <typename Take>
void forEachPairOfTiles(const openvdb::FloatTree& tree, Take&& take) {
    const openvdb::FloatGrid::ConstAccessor accessor(tree);
    openvdb::FloatTree::ValueAllCIter tile = tree.cbeginValueAll();
    tile.setMaxDepth(openvdb::FloatTree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        const int side = box.dim()[0];
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
            VoxelPair pair;
            pair.a = box.min();
            pair.a[axis] = face % 2 ? box.max()[axis] : box.min()[axis];
            pair.b = pair.a;
            pair.b[axis] += face % 2 ? 1 : -1;
            pair.valueA = *tile;
            pair.activeA = tile.isValueOn();
            pair.span = accessor.getValueDepth(pair.b) <= int(tile.getDepth()) ? side : 8;
            const openvdb::Coord a = pair.a, b = pair.b;
            for (int i = 0; i < side; i += pair.span)
                for (int j = 0; j < side; j += pair.span) {
                    pair.a = a, pair.b = b;
                    pair.a[u] += i, pair.b[u] += i;
                    pair.a[v] += j, pair.b[v] += j;
                    if (accessor.probeConstLeaf(pair.b)) continue;
                    pair.activeB = accessor.probeValue(pair.b, pair.valueB);
                    if (!(pair.activeA && pair.activeB)) take(pair);
                }
        }
    }
}

}  // namespace vdbsynth
