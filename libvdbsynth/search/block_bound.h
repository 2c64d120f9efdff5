#pragma once
#include "libvdbsynth/search/block_index_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A query's means over cubes, those of them that are wholly known.
struct QueryLevel {
    std::vector<float> mean;
    std::vector<Index3> offset;
    double weight = 0;  ///< samples in a cube over known samples
};

/// @param cell   side of the cubes [voxels]; 1: the samples themselves
/// @param known  number of known samples
QueryLevel queryLevel(const BlockQuery& query, int block, int cell, std::int64_t known);

/// What blockCost is at least, from the means of one level [lagae2004, Eq. 2]; in floats, lowered by what
/// their rounding may be.
class LevelBound {
public:
    /// @param margin  by how much two means may differ by rounding
    LevelBound(const QueryLevel& level, float margin);

    /// A sum of squares that is no more than this may be within a limit.
    float squaresFor(double limit) const;
    /// From the sum of squares: by the triangle inequality the margin comes off its root.
    float from(float squares) const {
        const float left = std::max(std::sqrt(squares) - mMargin, 0.f);
        return left * left * mScale;
    }
    std::size_t meanCount() const { return mLevel.mean.size(); }
    /// Sum of squares of the block at a position; once it exceeds the limit, something that does.
    float ofNode(const LevelField& field, const Index3& position, float limit) const;

private:
    friend class CubeBounds;
    const QueryLevel& mLevel;
    float mMargin, mScale;  // margin of all means together
    int mReach = 0;         // largest offset
};

/// Bounds of all positions of a cube at once: the samples that they share are read once, and eight
/// neighbours along z are bounded side by side.
class CubeBounds {
public:
    /// @param corner  cubeCorner of the cube
    /// @param limit   sums of rows that all exceed it may be left at any that do
    /// @param rows    bit x * kNodeCube + y for each row along z that is wanted
    /// @return one sum of squares for each placeInCube of those rows, valid until the next call
    const std::vector<float>& bound(const LevelBound& level, const LevelField& field, const Index3& corner,
                                    float limit, std::uint64_t rows = ~std::uint64_t(0));

private:
    std::vector<float> mSamples, mSums;
    std::vector<std::ptrdiff_t> mSteps;
};

}  // namespace vdbsynth
