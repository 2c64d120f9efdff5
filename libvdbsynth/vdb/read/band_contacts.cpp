#include "libvdbsynth/vdb/read/band_contacts.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/read/neighbour_pairs.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

void add(BandContacts& contacts, const VoxelPair& pair, double width, double step) {
    const float a = pair.valueA, b = pair.valueB;
    const bool otherSigns = (a < 0) != (b < 0);
    if (otherSigns) {
        if (std::abs(double(a) - double(b)) > step) ++contacts.jumps;
        return;
    }
    if (!pair.activeA && !pair.activeB) return;
    const double active = double(pair.activeA ? a : b), inactive = double(pair.activeA ? b : a);
    BandSide& side = active < 0 ? contacts.inside : contacts.outside;
    ++side.voxels;
    if (std::abs(active) < width - step) ++side.early;
    contacts.deepest = std::min(contacts.deepest, inactive);
    contacts.farthest = std::max(contacts.farthest, inactive);
}

void add(BandSide& side, const BandSide& other) {
    side.voxels += other.voxels;
    side.early += other.early;
}

}  // namespace

BandContacts bandContactsOf(const openvdb::FloatGrid& grid, double step, const RunContext& ctx) {
    constexpr std::size_t kGrain = 32;
    const double width = double(grid.background());
    std::vector<const Leaf*> leaves;
    grid.tree().getNodes(leaves);
    std::vector<BandContacts> parts((leaves.size() + kGrain - 1) / kGrain);
    parallelFor(ctx, leaves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        const openvdb::FloatGrid::ConstAccessor accessor = grid.getConstAccessor();
        for (std::size_t i = begin; i < end; ++i)
            forEachPairOfLeaf(*leaves[i], accessor,
                              [&](const VoxelPair& pair) { add(parts[begin / kGrain], pair, width, step); });
    });
    BandContacts all;
    forEachPairOfTiles(grid.tree(), [&](const VoxelPair& pair) { add(all, pair, width, step); });
    for (const BandContacts& part : parts) {
        add(all.inside, part.inside);
        add(all.outside, part.outside);
        all.jumps += part.jumps;
        all.deepest = std::min(all.deepest, part.deepest);
        all.farthest = std::max(all.farthest, part.farthest);
    }
    return all;
}

}  // namespace vdbsynth
