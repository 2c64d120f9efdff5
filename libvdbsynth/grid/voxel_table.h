#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/lattice.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vdbsynth {

/// A sparse set of voxels, numbered in the order of their bricks: element i of an array
/// holds the data of voxel i.
class VoxelTable {
public:
    VoxelTable() = default;
    /// The voxels of a field's box whose value is wanted.
    /// @param wanted  a pure function of the value; called once for a brick of one value
    /// @par Cost    O(bricks + voxels of those that are not constant)
    /// @par Repeats same numbers for any number of threads
    static VoxelTable where(const BrickField& field, const std::function<bool(float)>& wanted,
                            const RunContext& ctx = {});
    /// The given voxels, numbered in their order. @param box  contains them all; no duplicates
    static VoxelTable of(const IndexBox& box, std::vector<Index3> voxels);

    std::size_t size() const { return mVoxels.size(); }
    const std::vector<Index3>& voxels() const { return mVoxels; }
    const Index3& operator[](std::size_t i) const { return mVoxels[i]; }
    /// Number of a voxel, negative if it is not in the set.
    std::int32_t find(const Index3& p) const {
        if (!mBox.contains(p)) return -1;
        const int x = p.x - mBox.min.x, y = p.y - mBox.min.y, z = p.z - mBox.min.z;
        const std::int32_t slot = mSlots[brickIndex(x >> 3, y >> 3, z >> 3)];
        if (slot < 0) return -1;
        return mNumbers[std::size_t(slot) * BrickField::kSamples +
                        std::size_t((((x & 7) << 3) | (y & 7)) << 3 | (z & 7))];
    }

private:
    std::size_t brickIndex(int bx, int by, int bz) const { return latticeIndex({bx, by, bz}, mBricks); }

    explicit VoxelTable(const IndexBox& box);

    IndexBox mBox;
    Index3 mBricks;
    std::vector<std::int32_t> mSlots;    // per brick: number of its table, or -1
    std::vector<std::int32_t> mNumbers;  // kSamples per table
    std::vector<Index3> mVoxels;
};

}  // namespace vdbsynth
