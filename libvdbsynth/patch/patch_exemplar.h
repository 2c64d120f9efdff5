#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The two axes along which a geometry texture lies; the third is its height.
enum class PatchPlane { XY, YZ, ZX };

/// Turns a place or direction so that the plane is x, y and the height z: a cyclic change of axes, so that
/// nothing is mirrored.
Vec3d toPlane(PatchPlane plane, const Vec3d& world);
/// The inverse of toPlane.
Vec3d fromPlane(PatchPlane plane, const Vec3d& place);

/// A geometry texture [duranleau2006, section 3]: oriented points that continue beyond a box. Plane space: x
/// and y along the reference plane, z the height, the box's minimum corner at the origin.
struct PatchExemplar {
    std::vector<Vec3f> points;   ///< [points] plane space [world]; in the box and in a margin around it
    std::vector<Vec3f> normals;  ///< [points] of length 1
    std::vector<std::uint32_t> number;  ///< [points] of the cloud that it was made from
    Vec3d size;                         ///< [world] of the box
    double spacing = 0;                 ///< [world] median of the points' distances to their neighbours
    double kernel = 2;  ///< [spacings] 1..8, of its points' surface (points/point_set_surface.h)
    PatchPlane plane = PatchPlane::XY;
    Vec3d corner;  ///< [world] the box's minimum corner, axes as in the file

    /// From plane space to the file's.
    Vec3d toWorld(const Vec3d& place) const { return fromPlane(plane, place) + corner; }
};

/// The box of a texture, axes as in the file [world].
struct PatchBox {
    Vec3d min, max;
};

/// @param points, normals  world space, finite; normals of any length over 0
/// @param spacing  [world] of the points, over 0
/// @param fitHeight  along the height the box is made larger where it does not hold all points and two
/// spacings beyond them
/// @throw Error ShapeMismatch (other number of normals), EmptyInput (no point in the box), InvalidOption (an
/// empty box, a spacing that is not above 0)
/// @par Cost    O(points)   @par Repeats yes
PatchExemplar patchExemplar(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                            const PatchBox& box, PatchPlane plane, double spacing, bool fitHeight = true);

/// The kernel that suits points: 2, or 1 where over a twentieth of them lie on thin parts, with a point that
/// faces the other way among their 48 nearest and within 6 spacings: wide kernels mix both sides there.
/// @par Cost    O(points log points)   @par Repeats same bits for any number of threads
double fittingKernel(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals, double spacing,
                     const RunContext& ctx = {});

}  // namespace vdbsynth
