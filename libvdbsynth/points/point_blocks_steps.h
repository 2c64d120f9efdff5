#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Points in blocks of cells, for the steps of point_set_surface.h and even_sampling.h.
namespace vdbsynth {

/// Points that count once, with normals of length 1.
struct OrientedPoints {
    std::vector<Vec3f> point, normal;
};

/// Which points count, by the angle of their normals to a direction: not at all where the cosine is at most
/// `none`, fully from a quarter more on.
struct SheetFacing {
    Vec3f direction;
    float none = -2;

    float share(const Vec3f& normal) const {
        const float above = 4 * (dot(direction, normal) - none);
        return above < 0 ? 0 : above < 1 ? above : 1;
    }
};

/// A point as it is stored: all of it in one half of a cache line.
struct StoredPoint {
    Vec3f point;
    float inverse = 0;  ///< 1 / reach^2
    Vec3f normal;
    float reach = 0;
};

/// How far one of two points lies from all circles that go through the other at right angles to both normals:
/// of a sphere 0. The square of its distance along the mean of the normals, over (2 h)^2.
/// @param squaredReach  12 h^2
inline float squaredApart(const Vec3f& chord, const Vec3f& sumOfNormals, float squaredReach) {
    const float off = dot(chord, sumOfNormals);
    return 3 * off * off / (dot(sumOfNormals, sumOfNormals) * squaredReach);
}

/// Share of a point in the sheet of another: 1 within 104 degrees of its normal and 1.15 h of its circles, 0
/// from 120 degrees or 2 h on.
inline float sheetShare(float cosine, float apart) {
    const float facing = 4 * (cosine + 0.5f), near = 1.5f * (1 - apart);
    return (facing < 0 ? 0 : facing < 1 ? facing : 1) * (near < 0 ? 0 : near < 1 ? near : 1);
}

/// The sheet that a point is of.
struct Sheet {
    const SheetFacing* given = nullptr;  ///< only points with a share in it
    StoredPoint anchor;

    struct Shares {
        float rough = 0, anchors = 0;
        bool sure = false;  ///< full, and full for all anchors near this one
    };
    Shares shares(const StoredPoint& other) const {
        const float apart = squaredApart(other.point - anchor.point, other.normal + anchor.normal,
                                         anchor.reach * anchor.reach);
        const float cosine = dot(other.normal, anchor.normal), asked = given ? given->share(other.normal) : 1;
        Shares shares;
        // To 150 degrees and 3 h.
        shares.rough = cosine > -0.866f && apart < 2.25f ? asked : 0;
        shares.anchors = asked * sheetShare(cosine, apart);
        shares.sure = cosine > 0.3f && apart < 0.0625f && asked == 1;
        return shares;
    }
};

/// Eight points near a centre, relative to it. Unused places have a share of 0.
struct PointPack {
    typedef float Lanes __attribute__((vector_size(32), aligned(4)));
    Lanes x, y, z, normalX, normalY, normalZ;
    Lanes inverse;  ///< 1 / reach^2
    Lanes rough;    ///< share in any sheet that the anchor may be of
    Lanes anchors;  ///< share in the anchor's own sheet
    Lanes share;    ///< that counts
};

inline constexpr float kCellOverReach = 0.5f;  ///< of points whose reach is the median

/// Points in cells of about half the reach of their kernels, cells in sparse blocks of 8^3; points whose
/// reach differs by more than a factor of two are on different levels.
class PointBlocks {
public:
    /// @param reach  [n] above 0, finite
    PointBlocks(const OrientedPoints& points, const std::vector<float>& reach);

    /// Number of the point of largest weight at a place, negative if none reaches it; of equal ones the one
    /// stored first. @param facing  only points with a share, nullptr: any
    std::int64_t heaviest(const Vec3f& place, const SheetFacing* facing) const;
    /// The points of a sheet within (1 + more) of their reach of a centre.
    /// @return whether all surely have a full share
    bool gather(const Vec3f& centre, const Sheet& sheet, float more, std::vector<PointPack>& packs) const;
    /// Calls visit(begin, end) for runs of points that hold all those within `part` of their reach of a
    /// place.
    template <typename Visit>
    void forRuns(const Vec3f& place, float part, Visit&& visit) const;

    const std::vector<StoredPoint>& points() const { return mPoints; }
    const StoredPoint& operator[](std::size_t i) const { return mPoints[i]; }
    std::uint32_t number(std::size_t i) const { return mNumbers[i]; }  ///< in the order of the input
    std::size_t occupied() const;                                      ///< cells
    float leastReach() const { return mLeastReach; }
    const Vec3f& low() const { return mLow; }  ///< of the box of all that points reach
    const Vec3f& high() const { return mHigh; }

private:
    struct Level {
        int number = 0;
        float cell = 0, inverseCell = 0;
        float reach = 0;  // the largest
    };
    struct Block {
        std::int32_t x = 0, y = 0, z = 0, level = 0, slot = -1;
    };
    // Cells of a block, first to last along each axis.
    struct Cells {
        std::size_t first = 0;  // of the block, in mStarts
        std::int32_t corner[3] = {}, from[3] = {}, to[3] = {};
    };

    const Level& levelOf(float reach);
    std::size_t place(const Block& block) const;
    std::int32_t addedSlot(const Block& block);
    std::size_t cellOf(const Vec3f& point, float reach);
    template <typename Visit>
    void forBlocks(const Level& level, const Vec3f& place, float within, Visit&& visit) const;
    template <typename Visit>
    void forRows(const Level& level, const Cells& cells, const Vec3f& place, float within,
                 Visit&& visit) const;

    float mMedianReach = 0, mLeastReach = 0;
    Vec3f mLow, mHigh;
    std::vector<Level> mLevels;
    std::vector<Block> mTable;  // open addressing, a power of two
    std::int32_t mBlocks = 0;
    std::vector<std::uint32_t> mStarts;  // [blocks * 512 + 1] first point of each cell
    std::vector<StoredPoint> mPoints;
    std::vector<std::uint32_t> mNumbers;
};

inline constexpr int kBlockSide = 8;  // cells
inline constexpr std::size_t kBlockCells = 512;

/// The cell of a coordinate; those over 2^28 cells from the origin share the last ones.
inline std::int32_t blockCell(float x, float inverseCell) {
    constexpr float kFarthest = 1 << 28;
    const float place = std::min(std::max(x * inverseCell, -kFarthest), kFarthest);
    const auto cell = std::int32_t(place);  // quicker than std::floor
    return cell - (float(cell) > place ? 1 : 0);
}

// The blocks of a level with cells that may hold points within a distance of a place.
template <typename Visit>
void PointBlocks::forBlocks(const Level& level, const Vec3f& p, float within, Visit&& visit) const {
    std::int32_t low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = blockCell(p[axis] - within, level.inverseCell);
        high[axis] = blockCell(p[axis] + within, level.inverseCell);
    }
    for (std::int32_t bz = low[2] >> 3; bz <= high[2] >> 3; ++bz)
        for (std::int32_t by = low[1] >> 3; by <= high[1] >> 3; ++by)
            for (std::int32_t bx = low[0] >> 3; bx <= high[0] >> 3; ++bx) {
                const std::int32_t slot = mTable[place({bx, by, bz, level.number, -1})].slot;
                if (slot < 0) continue;
                Cells cells;
                cells.first = std::size_t(slot) * kBlockCells;
                const std::int32_t block[3] = {bx, by, bz};
                for (int axis = 0; axis < 3; ++axis) {
                    cells.corner[axis] = block[axis] * kBlockSide;
                    cells.from[axis] = std::max(low[axis] - cells.corner[axis], 0);
                    cells.to[axis] = std::min(high[axis] - cells.corner[axis], kBlockSide - 1);
                }
                visit(cells);
            }
}

// Of the rows of these cells along x the parts within the distance of the place.
template <typename Visit>
void PointBlocks::forRows(const Level& level, const Cells& cells, const Vec3f& p, float within,
                          Visit&& visit) const {
    const auto squaredGap = [&](float x, std::int32_t cell) {
        const float low = float(cell) * level.cell;
        const float gap = std::max(std::max(low - x, x - (low + level.cell)), 0.f);
        return gap * gap;
    };
    // The gaps are rounded: a little more than the distance.
    const float most = 1.001f * within * within;
    for (std::int32_t z = cells.from[2]; z <= cells.to[2]; ++z) {
        const float leftZ = most - squaredGap(p.z, cells.corner[2] + z);
        for (std::int32_t y = cells.from[1]; y <= cells.to[1]; ++y) {
            const std::uint32_t* const row = &mStarts[cells.first + std::size_t(z << 6 | y << 3)];
            if (row[cells.from[0]] == row[cells.to[0] + 1]) continue;
            const float left = leftZ - squaredGap(p.y, cells.corner[1] + y);
            if (left < 0) continue;
            const float half = std::sqrt(left);
            const std::int32_t from = std::max(blockCell(p.x - half, level.inverseCell) - cells.corner[0],
                                               cells.from[0]),
                               to = std::min(blockCell(p.x + half, level.inverseCell) - cells.corner[0],
                                             cells.to[0]);
            if (from <= to && row[from] < row[to + 1]) visit(row[from], row[to + 1]);
        }
    }
}

template <typename Visit>
void PointBlocks::forRuns(const Vec3f& p, float part, Visit&& visit) const {
    for (const Level& level : mLevels) {
        const float within = level.reach * part;
        forBlocks(level, p, within, [&](const Cells& cells) { forRows(level, cells, p, within, visit); });
    }
}

}  // namespace vdbsynth
