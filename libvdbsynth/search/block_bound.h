#pragma once
#include "libvdbsynth/search/block_index_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A query's means over cubes that are entirely known.
struct QueryLevel {
    std::vector<float> mean;
    std::vector<Index3> offset;
    double weight = 0;  ///< samples in a cube over known samples
};

/// @param cell   side of the cubes [voxels]; 1: the samples themselves
/// @param known  number of known samples
QueryLevel queryLevel(const BlockQuery& query, int block, int cell, std::int64_t known);

/// A lower bound of blockCost from the means of one level [lagae2004, Eq. 2]; in floats, reduced by their
/// possible rounding error.
class LevelBound {
public:
    /// @param margin  possible rounding error of a difference of two means
    LevelBound(const QueryLevel& level, float margin);

    /// A sum of squares up to this may be within a limit.
    float squaresFor(double limit) const;
    /// From the sum of squares: by the triangle inequality the margin is subtracted from its root.
    float from(float squares) const {
        const float left = std::max(std::sqrt(squares) - mMargin, 0.f);
        return left * left * mScale;
    }
    std::size_t meanCount() const { return mLevel.mean.size(); }
    /// Sum of squares of the block at a position; once it exceeds the limit, some value that does.
    float ofNode(const LevelField& field, const Index3& position, float limit) const;

private:
    friend class CubeBounds;
    const QueryLevel& mLevel;
    float mMargin, mScale;  // margin of all means together
    int mReach = 0;         // largest offset
};

/// Bounds of all positions of a cube at once: shared samples are read once, and eight neighbours along z are
/// bounded in parallel.
class CubeBounds {
public:
    /// @param corner  cubeCorner of the cube
    /// @param limit   if all sums of a row exceed it, they may have any value that does
    /// @param rows    bit x * kNodeCube + y for each requested row along z
    /// @return one sum of squares for each placeInCube of those rows, valid until the next call
    const std::vector<float>& bound(const LevelBound& level, const LevelField& field, const Index3& corner,
                                    float limit, std::uint64_t rows = ~std::uint64_t(0));

private:
    std::vector<float> mSamples, mSums;
    std::vector<std::ptrdiff_t> mSteps;
};

}  // namespace vdbsynth
