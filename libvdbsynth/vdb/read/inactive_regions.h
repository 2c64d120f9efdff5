#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The connected regions of a tree's inactive voxels, and the signs of the active voxels around each: what a
/// region's own values should have been. Active voxels of infinite value are a fence without a sign.
/// @par Cost     memory as the tree's, some microseconds per leaf
/// @par Repeats  same bits for any number of threads
class InactiveRegions {
public:
    /// @param bySign  voxels of other signs belong to other regions
    InactiveRegions(const openvdb::FloatTree& tree, bool bySign, const RunContext& ctx);

    struct Votes {
        std::uint64_t negative = 0, positive = 0;
    };

    /// Region 0 lies around all others and reaches infinity.
    int regionAt(const openvdb::Coord& inactive) const { return find(mLabels.getValue(inactive)); }
    Votes votes(int region) const { return mVotes[std::size_t(region)]; }
    Votes outside() const { return votes(find(0)); }
    bool isOutside(int region) const { return region == find(0); }
    /// Where active voxels touch a region that mostly touches the other sign, the outside left out.
    std::uint64_t minorities() const;

    /// True if some region but the outside touches no active voxel, so that nothing tells its sign.
    bool hasUnvoted() const;

    /// The region of every inactive voxel; -1 where active.
    const openvdb::Int32Tree& labels() const { return mLabels; }
    int find(int label) const;

private:
    int added();
    void join(int a, int b);
    void label(openvdb::Int32Tree::LeafNodeType& labels, const openvdb::FloatTree::LeafNodeType& values);

    const bool mBySign;
    openvdb::Int32Tree mLabels;
    std::vector<int> mParent;
    std::vector<Votes> mVotes;
};

}  // namespace vdbsynth
