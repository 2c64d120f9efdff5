#pragma once
#include "libvdbsynth/patch/scanline/scanline_patches.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vdbsynth {

/// A point of the growing sheet.
struct ScanlinePoint {
    Vec3f point, normal;
    float variation = 0;
    std::uint32_t source = 0;
    std::int32_t patch = 0;
    std::uint8_t blended = 0;
};

/// A part of the plane, over the full height.
struct PlaneBox {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool holds(const Vec3f& p) const {
        return double(p.x) >= x0 && double(p.x) < x1 && double(p.y) >= y0 && double(p.y) < y1;
    }
    PlaneBox grown(double by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
};

/// T_out: a hashed grid of buckets of points.
class PointBuckets {
public:
    explicit PointBuckets(double side) : mSide(side) {}

    std::vector<ScanlinePoint> gathered(const PlaneBox& box) const;
    void removeInside(const PlaneBox& box);
    void insert(const ScanlinePoint& point);
    /// In the order of the buckets' places, y first.
    std::vector<ScanlinePoint> all() const;

private:
    static std::uint64_t keyOf(int i, int j) {
        return (std::uint64_t(std::uint32_t(i)) << 32) | std::uint32_t(j);
    }
    template <typename Visit>
    void eachKey(const PlaneBox& box, const Visit& visit) const;

    double mSide;
    std::unordered_map<std::uint64_t, std::vector<ScanlinePoint>> mBuckets;
};

/// A patch that is being laid: box of P and where it overlaps others.
struct ScanlinePatch {
    double x = 0, y = 0;               // of the corner of P on the sheet
    double side = 0, margin = 0;       // [world]
    bool left = false, below = false;  // patches lie there

    PlaneBox box() const { return {x, y, x + side + margin, y + side + margin}; }
    /// How much of what lies there a place keeps: 1 at the outer edge of O, 0 at the inner.
    double kept(const Vec3f& place) const;
};

/// Pairs the patch's points with clusters of what lies in the overlap and warps them.
/// @param points  F_k with a margin more on all sides, on the sheet
/// @return number of pairs; fewer than four: not warped
std::size_t warpToNeighbours(const ScanlinePatch& patch, const std::vector<ScanlinePoint>& neighbours,
                             double spacing, const ScanlineOptions& options,
                             std::vector<ScanlinePoint>& points, const RunContext& ctx);

/// Moves points over the overlap toward what lies there.
void blendToNeighbours(const ScanlinePatch& patch, const PointSetSurface& surface,
                       std::vector<ScanlinePoint>& points, const RunContext& ctx);

}  // namespace vdbsynth
