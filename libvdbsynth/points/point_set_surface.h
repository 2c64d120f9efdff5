#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <memory>
#include <optional>
#include <vector>

namespace vdbsynth {

/// What is fitted to the points around a place x.
enum class PointSetKind {
    Apss,   ///< a sphere [guennebaud2007]: right on planes and spheres, at least bias on all smooth surfaces
    Rimls,  ///< robust planes [oztireli2009]: keeps creases, shrinks what is curved
    AdamsonAlexa  ///< the plane of the mean point and mean normal [adamson2003]: as the 2006 paper has it
};

struct PointSetSurfaceOptions {
    PointSetKind kind = PointSetKind::Apss;
    double kernel = 2;         ///< [local spacings] 1..8, standard deviation of the weights on the surface
    double normalWidth = 0.5;  ///< 0.1..2, RIMLS's sigma_n: normals that differ by more count for little
    bool sharp = true;  ///< of Apss: RIMLS where normals disagree more than curvature explains (creases)
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointSetSurfaceOptions& options);

/// A place on the surface.
struct SurfaceFoot {
    Vec3d point;   ///< [world]
    Vec3d normal;  ///< there, outward, length 1
};

/// The surface that oriented points describe: the places x at which what is fitted to the points around x
/// goes through x. Points count by w = (1 - d^2 / R^2)^4 for distances d < R, R^2 = 12 h^2, which has on a
/// plane the same second moment, 2 h^2, as the Gaussian of standard deviation h = `kernel` * the point's own
/// spacing: kernels follow the local density. Beyond R (6.9 spacings by default) there is no surface.
///
/// Close sheets are kept apart. The query chooses the point of largest weight; of the others only those count
/// that may be of one sheet with it. Their normals are within 120 degrees of the mean normal (from 104
/// degrees on they count less), and the chord from the mean point, along the mean of both normals, is at most
/// 2 h (from 1.15 h on they count less): on a circle it is 0. These means are by kernels of half the reach,
/// so that nothing jumps from point to point. Surfaces that end continue beyond their last points by some
/// spacings.
///
/// All members are const and may be called from many threads. Same bits always.
class PointSetSurface {
public:
    /// @param points   [n] finite; coinciding ones that face the same way count once
    /// @param normals  [n] outward, of any length but zero
    /// @throw Error InvalidOption (options), ShapeMismatch (normals of another number), EmptyInput (no
    /// points), BadData (a coordinate that is not finite, a normal without length), Cancelled
    /// @par Cost    O(n), where density varies by much O(n log n); a microsecond for each point
    PointSetSurface(std::vector<Vec3f> points, std::vector<Vec3f> normals,
                    const PointSetSurfaceOptions& options = {}, const RunContext& ctx = {});
    ~PointSetSurface();
    PointSetSurface(PointSetSurface&&) noexcept;
    PointSetSurface& operator=(PointSetSurface&&) noexcept;

    /// The foot of `place`: x = place projected on what is fitted at x, repeated until x moves by less than
    /// 1e-4 spacings, always from the original place, so that place - foot is along the normal
    /// [alexa2004, almost orthogonal projection]. Where that does not settle, as over a sharp edge, x
    /// itself is projected until it lies on the surface. Nothing where no point is near.
    /// @par Cost    2 to 3 microseconds
    std::optional<SurfaceFoot> project(const Vec3d& place) const;

    /// The foot on a sheet that faces as `facing` does: only points whose normals are within 90 degrees of it
    /// are looked at (from 75 degrees on they count less).
    /// @param facing  of any length but zero
    std::optional<SurfaceFoot> project(const Vec3d& place, const Vec3d& facing) const;

    /// The first place where the ray meets the surface, from either side: at origin + t * direction / its
    /// length, 0 <= t <= reach. Sheets that the ray enters and leaves within a quarter of a spacing may be
    /// missed. Space without points is crossed by steps of half the smallest kernel's reach, but at most
    /// 2000.
    /// @param direction  of any length but zero   @param reach  [world]
    /// @par Cost    about 6 microseconds for a hit
    std::optional<SurfaceFoot> intersect(const Vec3d& origin, const Vec3d& direction, double reach) const;
    /// The same on sheets that face as `facing` does.
    std::optional<SurfaceFoot> intersect(const Vec3d& origin, const Vec3d& direction, double reach,
                                         const Vec3d& facing) const;

    /// [world] Median over the points of their spacing: the side of the square that each has to itself, as
    /// 0.908 of the root mean square distance to the 6 nearest that face the same way; so within 7 % for
    /// points at random and on lattices. 0 for one point, or if all coincide: then there is no surface.
    double spacing() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

}  // namespace vdbsynth
