#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/point_blocks_steps.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <memory>
#include <optional>
#include <vector>

// Steps of point_set_surface.h. Lengths are in units of the surface's own, a power of two of the world's.
namespace vdbsynth {

/// Spacing of every point: the median of its own and of its neighbours', each the root mean square distance
/// to the 6 nearest that face the same way, times 0.908. So single points far from the others get no wide
/// kernel.
/// @param points  distinct; put in another order, in which near ones are near
/// @par Cost    O(n), but O(n log n) where density varies by much   @par Repeats same bits for any number of
/// threads
std::vector<float> facingSpacing(OrientedPoints& points, const RunContext& ctx);

/// Sets the shares at a place as sheetShare has them, but of the mean point and normal there instead of a
/// single point, by kernels of half the reach: they change smoothly with the place.
/// @param place  relative to the packs' centre    @param reach  of a point there
void sharesOfSheet(std::vector<PointPack>& packs, const Vec3f& place, float reach);

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
    bool mGathered = false, mSure = false;
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
