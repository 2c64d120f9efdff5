#include "libvdbsynth/search/block_bound.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kLanes = kNodeCube;
constexpr std::size_t kBetweenLooks = 64;  // means after which a row that exceeds the limit is left

constexpr int kRows = 4;  // of eight positions, side by side: sums that do not wait for each other

// Adds the squares of what the means of positions differ by from the query's.
// @param row  step from one row to the next
__attribute__((target_clones("avx2", "default"))) void addSquares(const float* samples, std::ptrdiff_t row,
                                                                  const std::ptrdiff_t* steps,
                                                                  const float* means, std::size_t count,
                                                                  float* sums) {
    float lanes[kRows][kLanes];
    for (int r = 0; r < kRows; ++r)
        for (int k = 0; k < kLanes; ++k) lanes[r][k] = sums[r * kLanes + k];
    for (std::size_t i = 0; i < count; ++i) {
        const float* from = samples + steps[i];
        const float mean = means[i];
        for (int r = 0; r < kRows; ++r)
            for (int k = 0; k < kLanes; ++k) {
                const float d = from[r * row + k] - mean;
                lanes[r][k] += d * d;
            }
    }
    for (int r = 0; r < kRows; ++r)
        for (int k = 0; k < kLanes; ++k) sums[r * kLanes + k] = lanes[r][k];
}

}  // namespace

QueryLevel queryLevel(const BlockQuery& query, int block, int cell, std::int64_t known) {
    QueryLevel level;
    level.weight = double(cell) * cell * cell / double(known);
    const int perSide = block / cell;
    for (int x = 0; x < perSide; ++x)
        for (int y = 0; y < perSide; ++y)
            for (int z = 0; z < perSide; ++z) {
                double sum = 0;
                bool whole = true;
                for (int i = 0; i < cell && whole; ++i)
                    for (int j = 0; j < cell && whole; ++j) {
                        const std::size_t row =
                            (std::size_t(x * cell + i) * std::size_t(block) + std::size_t(y * cell + j)) *
                                std::size_t(block) +
                            std::size_t(z * cell);
                        for (int k = 0; k < cell; ++k) {
                            if (query.known && !query.known[row + std::size_t(k)]) {
                                whole = false;
                                break;
                            }
                            sum += double(query.samples[row + std::size_t(k)]);
                        }
                    }
                if (!whole) continue;
                level.mean.push_back(float(sum / (double(cell) * cell * cell)));
                level.offset.push_back({x * cell, y * cell, z * cell});
            }
    return level;
}

LevelBound::LevelBound(const QueryLevel& level, float margin)
    : mLevel(level),
      mMargin(margin * std::sqrt(float(level.mean.size()))),
      // Each addition may round up by half a unit of the last place, and so may the square before it.
      mScale(float(level.weight * (1 - 2e-6 - 1.2e-7 * double(level.mean.size())))) {
    for (const Index3& offset : level.offset) mReach = std::max({mReach, offset.x, offset.y, offset.z});
}

float LevelBound::squaresFor(double limit) const {
    const double root = std::sqrt(limit / double(mScale)) + double(mMargin);
    return float(root * root * (1 + 1e-6));
}

float LevelBound::from(float squares) const {
    const float left = std::max(std::sqrt(squares) - mMargin, 0.f);
    return left * left * mScale;
}

float LevelBound::ofNode(const LevelField& field, const Index3& position, float limit) const {
    float sum = 0;
    for (std::size_t i = 0; i < mLevel.mean.size(); ++i) {
        const float d = field.at(position + mLevel.offset[i]) - mLevel.mean[i];
        sum += d * d;
        if (i % kLanes == kLanes - 1 && sum > limit) break;
    }
    return sum;
}

const std::vector<float>& CubeBounds::bound(const LevelBound& level, const LevelField& field,
                                            const Index3& corner, float limit) {
    const bool dense = !field.dense.samples.empty();
    const int side = kNodeCube + level.mReach;
    if (!dense) {
        mSamples.resize(std::size_t(side) * std::size_t(side) * std::size_t(side));
        field.bricks->readBox(corner, {side, side, side}, mSamples.data());
    }
    const float* samples = dense ? field.dense.row(corner.x, corner.y, corner.z) : mSamples.data();
    const std::ptrdiff_t row = dense ? field.dense.size.z : side,
                         plane = row * (dense ? field.dense.size.y : side);
    mSteps.clear();
    for (const Index3& o : level.mLevel.offset) mSteps.push_back(o.x * plane + o.y * row + o.z);
    mSums.assign(std::size_t(kNodeCube * kNodeCube * kNodeCube), 0.f);
    const std::size_t count = mSteps.size();
    for (int x = 0; x < kNodeCube; ++x)
        for (int y = 0; y < kNodeCube; y += kRows) {
            float* sums = mSums.data() + (x * kNodeCube + y) * kNodeCube;
            for (std::size_t i = 0; i < count; i += kBetweenLooks) {
                if (*std::min_element(sums, sums + kRows * kLanes) > limit) break;
                addSquares(samples + x * plane + y * row, row, mSteps.data() + i,
                           level.mLevel.mean.data() + i, std::min(kBetweenLooks, count - i), sums);
            }
        }
    return mSums;
}

}  // namespace vdbsynth
