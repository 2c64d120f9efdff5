#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/math/lattice.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vdbsynth {

inline constexpr int kSeamCell = 2;  ///< [voxels] side of the cells that seams run between

/// A field's distances clamped to 1.5 voxels, in 64ths of one: a byte a voxel, and sums that are exact.
class NearField {
public:
    static constexpr int kFar = 96;  ///< farther away than 1.5 voxels

    explicit NearField(const BrickField& field, const RunContext& ctx = {});
    explicit NearField(const DenseField& field);

    const Index3& size() const { return mSize; }
    /// True if the cell with a minimum corner lies inside.
    bool holds(const Index3& corner) const {
        return corner.x >= 0 && corner.y >= 0 && corner.z >= 0 && corner.x + kSeamCell <= mSize.x &&
               corner.y + kSeamCell <= mSize.y && corner.z + kSeamCell <= mSize.z;
    }
    /// True if the cell has a sample that is not far.
    bool hasSurface(const Index3& corner) const;
    /// Number of cells, in a lattice from the origin, that have a surface.
    std::size_t surfaceCells() const;

    /// Sum of the absolute differences between two cells.
    friend int cellDifference(const NearField& a, const Index3& p, const NearField& b, const Index3& q);

private:
    const std::int8_t* at(const Index3& p) const { return mSamples.data() + latticeIndex(p, mSize); }

    Index3 mSize;
    std::vector<std::int8_t> mSamples;
};

/// Cells over the target of a map of patches. Each has a margin over which its copy is blended: up to two
/// voxels, and small enough that some patch contains any cell with its margin.
class SeamCells {
public:
    explicit SeamCells(const PatchMap& map);

    const Index3& count() const { return mCount; }
    std::size_t total() const { return latticeCount(mCount); }
    std::size_t number(const Index3& cell) const { return latticeIndex(cell, mCount); }
    /// Where a cell begins in the target, without its margin.
    Index3 cornerOf(const Index3& cell) const {
        return {mCorners[0][std::size_t(cell.x)], mCorners[1][std::size_t(cell.y)],
                mCorners[2][std::size_t(cell.z)]};
    }
    /// A map with a block for each cell and its margin, still without arrays.
    const PatchMap& blocks() const { return mBlocks; }
    /// The cells that a patch contains, with their margins; may be empty.
    IndexBox inside(const Index3& patch) const;
    /// Of the patches that contain a cell and its margin, the number of the one with the
    /// largest weight in its middle.
    std::size_t strongestPatch(const PatchMap& map, const Index3& cell) const;

private:
    struct Span {
        int first, last;
    };
    PatchMap mBlocks;
    Index3 mCount, mPatches;
    std::vector<int> mCorners[3], mOrigins[3];  // of cells and of patches along each axis
    std::vector<float> mWeights;                // weights of a patch's voxels in a vote, along an axis
    std::vector<Span> mPatchesOver[3], mCellsInside[3];
};

/// Sorts boxes into groups, in order, such that no two boxes of a group touch, not even by corners; each box
/// goes into the first possible group of the last 64. Empty boxes are in none.
/// @param count  number of positions along each axis that the boxes lie in
std::vector<std::vector<std::int32_t>> groupsApart(const std::vector<IndexBox>& boxes, const Index3& count);

}  // namespace vdbsynth
