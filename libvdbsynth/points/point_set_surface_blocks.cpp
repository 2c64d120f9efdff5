#include "libvdbsynth/points/point_set_surface_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kMostLevels = 24;  // on either side of the median

float medianOf(std::vector<float> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

// The points are stored in the order of their cells.
PointBlocks::PointBlocks(const OrientedPoints& points, const std::vector<float>& reach)
    : mMedianReach(medianOf(reach)), mLeastReach(mMedianReach), mLow(points.point[0]), mHigh(mLow) {
    mTable.resize(64);
    const std::size_t n = reach.size();
    std::vector<std::size_t> cells(n);
    for (std::size_t i = 0; i < n; ++i) cells[i] = cellOf(points.point[i], reach[i]);
    mStarts.assign(std::size_t(mBlocks) * kBlockCells + 1, 0);
    for (std::size_t cell : cells) ++mStarts[cell + 1];
    for (std::size_t c = 1; c < mStarts.size(); ++c) mStarts[c] += mStarts[c - 1];
    std::vector<std::uint32_t> next(mStarts.begin(), mStarts.end() - 1);
    mPoints.resize(n);
    mNumbers.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t at = next[cells[i]]++;
        mPoints[at] = {points.point[i], 1 / (reach[i] * reach[i]), points.normal[i], reach[i]};
        mNumbers[at] = std::uint32_t(i);
        mLeastReach = std::min(mLeastReach, reach[i]);
        for (int axis = 0; axis < 3; ++axis) {
            mLow[axis] = std::min(mLow[axis], points.point[i][axis] - reach[i]);
            mHigh[axis] = std::max(mHigh[axis], points.point[i][axis] + reach[i]);
        }
    }
}

// Levels are an octave wide, the median in the middle of its own.
const PointBlocks::Level& PointBlocks::levelOf(float reach) {
    const int number =
        std::min(std::max(std::ilogb(reach / mMedianReach / kCellOverReach), -kMostLevels), kMostLevels);
    for (Level& level : mLevels)
        if (level.number == number) {
            level.reach = std::max(level.reach, reach);
            return level;
        }
    Level level;
    level.number = number;
    level.cell = std::ldexp(mMedianReach * kCellOverReach, number);
    level.inverseCell = 1 / level.cell;
    level.reach = reach;
    mLevels.push_back(level);
    return mLevels.back();
}

std::size_t PointBlocks::place(const Block& block) const {
    std::uint64_t mixed = (std::uint64_t(std::uint32_t(block.x)) << 32 | std::uint32_t(block.y)) +
                          (std::uint64_t(std::uint32_t(block.z)) << 8 | std::uint32_t(block.level + 64)) *
                              0x9e3779b97f4a7c15ull;
    mixed = (mixed ^ mixed >> 32) * 0xd6e8feb86659fd93ull;
    std::size_t at = std::size_t(mixed ^ mixed >> 32) & (mTable.size() - 1);
    for (; mTable[at].slot >= 0; at = (at + 1) & (mTable.size() - 1)) {
        const Block& other = mTable[at];
        if (other.x == block.x && other.y == block.y && other.z == block.z && other.level == block.level)
            break;
    }
    return at;
}

std::int32_t PointBlocks::addedSlot(const Block& block) {
    std::size_t at = place(block);
    if (mTable[at].slot >= 0) return mTable[at].slot;
    if (2 * std::size_t(mBlocks) >= mTable.size()) {
        std::vector<Block> old(2 * mTable.size());
        old.swap(mTable);
        for (const Block& kept : old)
            if (kept.slot >= 0) mTable[place(kept)] = kept;
        at = place(block);
    }
    mTable[at] = block;
    return mTable[at].slot = mBlocks++;
}

std::size_t PointBlocks::occupied() const {
    std::size_t cells = 0;
    for (std::size_t c = 0; c + 1 < mStarts.size(); ++c) cells += mStarts[c] < mStarts[c + 1];
    return cells;
}

std::size_t PointBlocks::cellOf(const Vec3f& p, float reach) {
    const Level& level = levelOf(reach);
    const std::int32_t x = blockCell(p.x, level.inverseCell), y = blockCell(p.y, level.inverseCell),
                       z = blockCell(p.z, level.inverseCell);
    const std::int32_t slot = addedSlot({x >> 3, y >> 3, z >> 3, level.number, -1});
    return std::size_t(slot) * kBlockCells + std::size_t((z & 7) << 6 | (y & 7) << 3 | (x & 7));
}

std::int64_t PointBlocks::heaviest(const Vec3f& p, const SheetFacing* facing) const {
    // Most places are near a point: balls of growing size around it, until one is not empty.
    for (const float part : {0.25f, 0.5f, 1.f}) {
        float least = part * part;
        std::int64_t best = -1;
        forRuns(p, part, [&](std::uint32_t begin, std::uint32_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Vec3f away = mPoints[i].point - p;
                const float ratio = dot(away, away) * mPoints[i].inverse;
                if (!(ratio < least) || (facing && !(facing->share(mPoints[i].normal) > 0))) continue;
                least = ratio;
                best = std::int64_t(i);
            }
        });
        if (best >= 0) return best;
    }
    return -1;
}

bool PointBlocks::gather(const Vec3f& centre, const Sheet& sheet, float more,
                         std::vector<PointPack>& packs) const {
    thread_local std::vector<std::uint32_t> numbers;
    std::size_t count = 0;
    const float limit = (1 + more) * (1 + more);
    forRuns(centre, 1 + more, [&](std::uint32_t begin, std::uint32_t end) {
        if (numbers.size() < count + (end - begin)) numbers.resize(2 * (count + (end - begin)));
        // Without a branch, which would be mispredicted half the time.
        std::uint32_t* next = numbers.data() + count;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Vec3f p = mPoints[i].point - centre;
            *next = i;
            next += dot(p, p) * mPoints[i].inverse < limit;
        }
        count = std::size_t(next - numbers.data());
    });
    bool sure = true;
    packs.resize((count + 7) / 8);
    if (count > 0) packs.back() = PointPack{};
    for (std::size_t k = 0; k < count; ++k) {
        const StoredPoint& stored = mPoints[numbers[k]];
        PointPack& pack = packs[k / 8];
        const std::size_t lane = k & 7;
        pack.x[lane] = stored.point.x - centre.x;
        pack.y[lane] = stored.point.y - centre.y;
        pack.z[lane] = stored.point.z - centre.z;
        pack.normalX[lane] = stored.normal.x;
        pack.normalY[lane] = stored.normal.y;
        pack.normalZ[lane] = stored.normal.z;
        pack.inverse[lane] = stored.inverse;
        const Sheet::Shares shares = sheet.shares(stored);
        pack.rough[lane] = shares.rough;
        pack.anchors[lane] = pack.share[lane] = shares.anchors;
        sure = sure && shares.sure;
    }
    return sure;
}

}  // namespace vdbsynth
