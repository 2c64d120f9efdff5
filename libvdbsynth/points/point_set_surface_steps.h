#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

// Steps of point_set_surface.h. Lengths are in units of the surface's own, a power of two of the world's.
namespace vdbsynth {

/// Points that count once, with normals of length 1.
struct OrientedPoints {
    std::vector<Vec3f> point, normal;
};

/// Spacing of every point: the median of its own and of its neighbours', each the root mean square distance
/// to the 6 nearest that face the same way, times 0.908. So single points far from the others get no wide
/// kernel.
/// @param points  distinct; put in another order, in which near ones are near
/// @par Cost    O(n), but O(n log n) where density varies by much   @par Repeats same bits for any number of
/// threads
std::vector<float> facingSpacing(OrientedPoints& points, const RunContext& ctx);

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

/// The sheet that a point is of: which other points count with it. Not those that face another way, and not
/// those of a parallel sheet, beside which no circle goes through both points at right angles to both
/// normals.
struct Sheet {
    SheetFacing facing;
    StoredPoint anchor;

    float share(const StoredPoint& other) const {
        // On a sphere, and along any circle, the chord is perpendicular to the sum of the normals.
        const Vec3f chord = other.point - anchor.point, sum = other.normal + anchor.normal;
        const float off = dot(chord, sum), size = dot(sum, sum) * anchor.reach * anchor.reach;
        // 1 up to 1.15 h, 0 from 2 h = 0.577 reach on.
        const float apart = 1.5f * (1 - off * off * 3 / size);
        const float near = apart < 0 ? 0 : apart < 1 ? apart : 1;
        return near * facing.share(other.normal);
    }
};

/// Eight points near a centre, relative to it. Unused places have a share of 0.
struct PointPack {
    typedef float Lanes __attribute__((vector_size(32), aligned(4)));
    Lanes x, y, z, normalX, normalY, normalZ;
    Lanes inverse;  ///< 1 / reach^2
    Lanes share;    ///< in the sheet
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
    /// The points within (1 + more) of their reach of a centre.
    void gather(const Vec3f& centre, const Sheet& sheet, float more, std::vector<PointPack>& packs) const;
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

/// What is fitted to the points around a place x: u(y) = constant + linear . (y - x) + square |y - x|^2.
/// Outside u > 0. Planes have square = 0.
struct SurfaceFit {
    double constant = 0, square = 0;
    Vec3d linear;

    struct Foot {
        Vec3d point, normal;
        double distance = 0;  ///< signed
    };
    /// The foot of a place; all relative to x. Nothing where the gradient vanishes.
    std::optional<Foot> foot(const Vec3d& place) const;
};

/// What is fitted around a place.
struct SurfaceFits {
    SurfaceFit smooth, sharp;
    double crease = 0;  ///< share of `sharp`, 0..1

    std::optional<SurfaceFit::Foot> foot(const Vec3d& place) const;
};

/// Fits to points around `place`, relative to the packs' centre. Nothing where no weight remains.
/// @param spread  h there: the standard deviation of the weights
std::optional<SurfaceFits> fitSurface(const std::vector<PointPack>& packs, const Vec3f& place, float spread,
                                      const PointSetSurfaceOptions& options);

/// What is fitted at places near each other: points are gathered again only where a place leaves those that
/// were, or where another sheet begins.
class SurfaceWalk {
public:
    /// @param facing  nullptr: that of the point of largest weight, with all within 120 degrees of it
    /// @param stay    [reach] places this near share what was gathered
    SurfaceWalk(const PointBlocks& blocks, const PointSetSurfaceOptions& options, const SheetFacing* facing,
                double stay)
        : mBlocks(blocks), mOptions(options), mGiven(facing), mStay(stay) {}

    /// Looks for the sheet at a place. @return whether there is one
    bool begin(const Vec3d& place);
    /// Its point of largest weight there.
    const StoredPoint& heaviest() const { return mBlocks[mHeaviest]; }
    /// The place on the tangent plane of that point, within a quarter of its reach.
    Vec3d onTangentPlane(const Vec3d& place) const;
    /// What is fitted at a place to the points of that sheet.
    std::optional<SurfaceFits> at(const Vec3d& place);
    double spacing() const;  ///< of the heaviest point

private:
    const PointBlocks& mBlocks;
    const PointSetSurfaceOptions& mOptions;
    const SheetFacing* mGiven;
    double mStay;
    Sheet mSheet;
    std::size_t mHeaviest = 0;
    bool mGathered = false;
    Vec3f mCentre;
};

struct PointSetSurface::Impl {
    PointSetSurfaceOptions options;
    double scale = 1;                     // a power of two: the blocks' units over the world's
    double spacing = 0;                   // [world]
    std::unique_ptr<PointBlocks> blocks;  // none where there is no surface

    bool inRange(const Vec3d& scaled) const;
    std::optional<SurfaceFoot> project(const Vec3d& place, const SheetFacing* facing) const;
    std::optional<SurfaceFoot> intersect(const Vec3d& origin, const Vec3d& direction, double reach,
                                         const SheetFacing* facing) const;
};

}  // namespace vdbsynth
