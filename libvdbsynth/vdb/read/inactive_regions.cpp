#include "libvdbsynth/vdb/read/inactive_regions.h"

#include "libvdbsynth/vdb/read/neighbour_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr double kBytesPerLeaf = 3000;

}  // namespace

InactiveRegions::InactiveRegions(const openvdb::FloatTree& tree, bool bySign, const RunContext& ctx)
    : mBySign(bySign), mLabels(tree, 0, -1, openvdb::TopologyCopy()) {
    requireMemory(ctx, double(tree.leafCount()) * kBytesPerLeaf, "repairing the signs of a level set",
                  "write it with right signs");
    (void)added();  // the outside
    openvdb::Int32Tree::ValueOffIter tile = mLabels.beginValueOff();
    tile.setMaxDepth(openvdb::Int32Tree::ValueOffIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tile.setValue(added());
    for (auto leaf = mLabels.beginLeaf(); leaf; ++leaf) label(*leaf, *tree.probeConstLeaf(leaf->origin()));
    throwIfCancelled(ctx);

    const openvdb::tree::ValueAccessor<const openvdb::Int32Tree> labels(mLabels);
    const auto take = [&](const VoxelPair& pair) {
        const int a = labels.getValue(pair.a), b = labels.getValue(pair.b);
        if (!pair.activeA && !pair.activeB) {
            if (!mBySign || (pair.valueA < 0) == (pair.valueB < 0)) join(a, b);
            return;
        }
        const float value = pair.activeA ? pair.valueA : pair.valueB;
        if (std::isinf(value)) return;
        Votes& votes = mVotes[std::size_t(pair.activeA ? b : a)];
        (value < 0 ? votes.negative : votes.positive) += std::uint64_t(pair.span) * std::uint64_t(pair.span);
    };
    const openvdb::FloatGrid::ConstAccessor accessor(tree);
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) forEachPairOfLeaf(*leaf, accessor, take);
    throwIfCancelled(ctx);
    forEachPairOfTiles(tree, take);
    for (int i = 0; i < int(mParent.size()); ++i) {
        const int root = find(i);
        mParent[std::size_t(i)] = root;
        if (root == i) continue;
        mVotes[std::size_t(root)].negative += mVotes[std::size_t(i)].negative;
        mVotes[std::size_t(root)].positive += mVotes[std::size_t(i)].positive;
    }
}

std::uint64_t InactiveRegions::minorities() const {
    std::uint64_t count = 0;
    for (int i = 0; i < int(mParent.size()); ++i)
        if (find(i) == i && !isOutside(i)) count += std::min(votes(i).negative, votes(i).positive);
    return count;
}

bool InactiveRegions::hasUnvoted() const {
    for (int i = 0; i < int(mParent.size()); ++i)
        if (find(i) == i && !isOutside(i) && votes(i).negative + votes(i).positive == 0) return true;
    return false;
}

int InactiveRegions::added() {
    mParent.push_back(int(mParent.size()));
    mVotes.push_back({});
    return mParent.back();
}

int InactiveRegions::find(int label) const {
    while (mParent[std::size_t(label)] != label) label = mParent[std::size_t(label)];
    return label;
}

// The lower label stays, so 0 is the outside's.
void InactiveRegions::join(int a, int b) {
    const int low = std::min(find(a), find(b)), high = std::max(find(a), find(b));
    mParent[std::size_t(high)] = low;
    // Shorter ways for the next ones.
    mParent[std::size_t(a)] = low;
    mParent[std::size_t(b)] = low;
}

// Regions within one leaf, from each unlabelled voxel to its neighbours.
void InactiveRegions::label(openvdb::Int32Tree::LeafNodeType& labels, const Leaf& values) {
    constexpr std::array<int, 3> kSteps{Leaf::DIM * Leaf::DIM, Leaf::DIM, 1};
    std::vector<int> open;
    for (int start = 0; start < int(Leaf::SIZE); ++start) {
        if (values.isValueOn(openvdb::Index(start)) || labels.getValue(openvdb::Index(start)) > 0) continue;
        const int region = added();
        open.assign(1, start);
        labels.setValueOff(openvdb::Index(start), region);
        while (!open.empty()) {
            const int n = open.back();
            open.pop_back();
            for (const int step : kSteps)
                for (const int m : {n - step, n + step}) {
                    const int at = n / step % int(Leaf::DIM);
                    if (m < n ? at == 0 : at == int(Leaf::DIM) - 1) continue;
                    const openvdb::Index to(m);
                    if (values.isValueOn(to) || labels.getValue(to) > 0) continue;
                    if (mBySign && (values.getValue(to) < 0) != (values.getValue(openvdb::Index(n)) < 0))
                        continue;
                    labels.setValueOff(to, region);
                    open.push_back(m);
                }
        }
    }
}

}  // namespace vdbsynth
