#pragma once
#include "libvdbsynth/patch/onto/surface_disk.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace vdbsynth {

/// A place of the surface under a disk, and how it changes along the disk's axes.
struct ChartPlace {
    Vec3d point, normal;               ///< [world]; the normal of length 1
    std::array<Vec3d, 2> alongPoint;   ///< derivatives of the point along the disk's x and y
    std::array<Vec3d, 2> alongNormal;  ///< [1 / world] and of the normal

    /// The principal curvatures [1 / world], positive where the surface is convex.
    std::array<double, 2> curvatures() const;
};

/// The surface as a smooth function of a disk's coordinates: at the nodes of a lattice, a field step apart,
/// points and normals are quadrics fitted to the disk's sites around by moving least squares, with weights
/// (1 - (d / 2.5 steps)^2)^2; between nodes Catmull and Rom's cubics run, so that the derivatives are
/// continuous.
class ChartSurface {
public:
    /// @param step  [world] above 0
    /// @par Cost    some microseconds for each site   @par Repeats yes
    ChartSurface(const SurfaceSites& sites, const SurfaceDisk& disk, double step);

    /// Nothing where the disk has too few sites around.
    std::optional<ChartPlace> at(double x, double y) const;

    /// Of the disk's members around a place on it the nearest to a place of the world; -1: none is near.
    /// @param sites, disk  of the constructor
    std::ptrdiff_t nearestMember(const SurfaceSites& sites, const SurfaceDisk& disk, const Vec2f& at,
                                 const Vec3d& point) const;

private:
    struct Node {
        Vec3d point, normal;
        bool known = false;
    };
    Node fitted(const SurfaceSites& sites, const SurfaceDisk& disk, double x, double y) const;
    void sortMembers(const SurfaceDisk& disk);

    double mStep;
    int mSide = 0;  // nodes of the lattice, which is a square
    double mLow = 0;
    std::vector<Node> mNodes;
    std::vector<std::size_t> mBegin;  // members by the cells of the lattice
    std::vector<std::uint32_t> mMembers;
};

}  // namespace vdbsynth
