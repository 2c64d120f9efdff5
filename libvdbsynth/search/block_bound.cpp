#include "libvdbsynth/search/block_bound.h"

#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kLanes = kNodeCube;
constexpr std::size_t kBetweenLooks = 16;  // means after which rows that exceed the limit are dropped

constexpr int kRows = 4;  // of eight positions, in parallel: sums that do not wait for each other

// In the compiler's vector types: for loops over arrays, GCC keeps each lane in a separate register.
typedef float Row __attribute__((vector_size(4 * kLanes)));
typedef float UnalignedRow __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

// Sums the squared differences of positions' means from the query's, until all exceed the limit.
__attribute__((target_clones("avx2", "default"))) void sumSquares(const float* const rows[kRows],
                                                                  const std::ptrdiff_t* steps,
                                                                  const float* means, std::size_t count,
                                                                  float limit, float* const sums[kRows]) {
    const float *const from0 = rows[0], *const from1 = rows[1], *const from2 = rows[2],
                       *const from3 = rows[3];
    Row sum0{}, sum1{}, sum2{}, sum3{};
    const auto add = [](Row & sum, const float* from, float mean) __attribute__((always_inline)) {
        const Row d = *reinterpret_cast<const UnalignedRow*>(from) - mean;
        sum += d * d;
    };
    for (std::size_t begin = 0; begin < count; begin += kBetweenLooks) {
        const std::size_t end = std::min(begin + kBetweenLooks, count);
        for (std::size_t i = begin; i < end; ++i) {
            add(sum0, from0 + steps[i], means[i]);
            add(sum1, from1 + steps[i], means[i]);
            add(sum2, from2 + steps[i], means[i]);
            add(sum3, from3 + steps[i], means[i]);
        }
        if (end == count) break;
        const Row least01 = sum0 < sum1 ? sum0 : sum1, least23 = sum2 < sum3 ? sum2 : sum3;
        const Row least = least01 < least23 ? least01 : least23;
        bool exceeds = true;
        for (int k = 0; k < kLanes; ++k) exceeds = exceeds && least[k] > limit;
        if (exceeds) break;
    }
    *reinterpret_cast<UnalignedRow*>(sums[0]) = sum0;
    *reinterpret_cast<UnalignedRow*>(sums[1]) = sum1;
    *reinterpret_cast<UnalignedRow*>(sums[2]) = sum2;
    *reinterpret_cast<UnalignedRow*>(sums[3]) = sum3;
}

}  // namespace

QueryLevel queryLevel(const BlockQuery& query, int block, int cell, std::int64_t known) {
    QueryLevel level;
    level.weight = double(cell) * cell * cell / double(known);
    const IndexBox cells = IndexBox::cube({0, 0, 0}, block / cell * cell);
    const auto addCell = [&](const Index3& corner) {
        double sum = 0;
        bool whole = true;
        for (int i = 0; i < cell && whole; ++i)
            for (int j = 0; j < cell && whole; ++j) {
                const std::size_t row = latticeIndex(corner + Index3{i, j, 0}, {block, block, block});
                for (int k = 0; k < cell; ++k) {
                    if (query.known && !query.known[row + std::size_t(k)]) {
                        whole = false;
                        break;
                    }
                    sum += double(query.samples[row + std::size_t(k)]);
                }
            }
        if (!whole) return;
        level.mean.push_back(float(sum / (double(cell) * cell * cell)));
        level.offset.push_back(corner);
    };
    forEachVoxel(cells, addCell, cell);
    return level;
}

LevelBound::LevelBound(const QueryLevel& level, float margin)
    : mLevel(level),
      mMargin(margin * std::sqrt(float(level.mean.size()))),
      // Each addition may round up by half a unit in the last place, and so may the square before it.
      mScale(float(level.weight * (1 - 2e-6 - 1.2e-7 * double(level.mean.size())))) {
    for (const Index3& offset : level.offset) mReach = std::max({mReach, offset.x, offset.y, offset.z});
}

float LevelBound::squaresFor(double limit) const {
    const double root = std::sqrt(limit / double(mScale)) + double(mMargin);
    return float(root * root * (1 + 1e-6));
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
                                            const Index3& corner, float limit, std::uint64_t rows) {
    const bool dense = !field.dense.samples.empty();
    const int side = kNodeCube + level.mReach;
    if (!dense) {
        mSamples.resize(latticeCount({side, side, side}));
        field.bricks->readBox(corner, {side, side, side}, mSamples.data());
    }
    const float* samples = dense ? field.dense.row(corner.x, corner.y, corner.z) : mSamples.data();
    const std::ptrdiff_t row = dense ? field.dense.size.z : side,
                         plane = row * (dense ? field.dense.size.y : side);
    mSteps.clear();
    for (const Index3& o : level.mLevel.offset) mSteps.push_back(o.x * plane + o.y * row + o.z);
    mSums.resize(std::size_t(kNodeCube * kNodeCube * kNodeCube));
    const float* from[kRows];
    float* to[kRows];
    while (rows != 0) {
        for (int r = 0; r < kRows; ++r) {  // repeats the last one if fewer than four are left
            if (rows != 0) {
                const int row8 = __builtin_ctzll(rows);
                from[r] = samples + row8 / kNodeCube * plane + row8 % kNodeCube * row;
                to[r] = mSums.data() + row8 * kNodeCube;
                rows &= rows - 1;
            } else {
                from[r] = from[r - 1];
                to[r] = to[r - 1];
            }
        }
        sumSquares(from, mSteps.data(), level.mLevel.mean.data(), mSteps.size(), limit, to);
    }
    return mSums;
}

}  // namespace vdbsynth
