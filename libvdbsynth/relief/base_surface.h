#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

/// How the base of a relief is made.
enum class BaseKind {
    Twicing,   ///< Gaussian mean of the distances, twice, so that curved surfaces do not shrink
    Gaussian,  ///< Gaussian mean of the distances; takes radius^2 / r off a sphere of radius r
    Flow,      ///< mean curvature flow for the time in which a Gaussian would spread as far
    Normals,   ///< bilateral means of the normals, then the surface that fits them: edges stay
    Quadrics   ///< the paper's local fits: a quadric by least squares around every point
};

struct BaseOptions {
    BaseKind kind = BaseKind::Twicing;
    double radius = 6;  ///< [voxels] 1..1000: standard deviation of the Gaussian; of waves as long as
                        ///< kCutOff * radius half goes to the base (Gaussian)
    float band = 3;     ///< [voxels] where the scan's own distances end, at least 1.5
    float reach = 3;    ///< [voxels] 3..150: the least that distances of the result are known for
};

/// Cut-off wavelength of a Gaussian over its standard deviation, 2 pi / sqrt(2 ln 2) [iso16610].
inline constexpr double kCutOff = 5.3364;

/// @throw Error InvalidOption (a field out of its range)
void validate(const BaseOptions& options);

/// [voxels] of void that a whole object has to have around it in the scan's box, to be smoothed as one.
int baseMargin(double radius);

/// A smooth base under a surface with relief.
struct BaseSurface {
    BrickField distance;   ///< [voxels] to the base, negative inside, clamped to -reach..reach
    BrickField scan;       ///< [voxels] to the scan's surface, clamped the same; the same box
    double radius = 6;     ///< [voxels] of the base's options
    float reach = 3;       ///< [voxels] that both are known for; holds the relief and two voxels
    double amplitude = 0;  ///< [voxels] distance from the base that a thousandth of the scan exceeds
    double beyond = 0;     ///< share of the scan's surface that is farther away than the reach: lost parts
};

/// The smooth surface under a relief.
///
/// Twicing: with D the scan's distances and G a Gaussian mean, B = 2 G D - G G D [tukey1977]: a mean moves a
/// surface of mean curvature H by radius^2 H, and the second one moves it back. Of a wave of length w the
/// base keeps 1 - (1 - g)^2 with g = 0.5^((kCutOff radius / w)^2), the relief (1 - g)^2. D is widened to five
/// radii first (four, and one for the relief), as a mean over a band that ends too early moves the surface.
/// From a radius of 5 on the means are taken on a lattice of every second to fourth voxel, of which each near
/// the surface holds the mean of the voxels around it, and interpolated by cubic polynomials (Catmull-Rom).
/// Flow moves the surface by its mean curvature for the time radius^2 / 2, in stable steps. Normals: means of
/// the surface's normals, first Gaussian, then four rounds over those normals whose means differ by under 41
/// degrees, so that edges return [zhang2015]; then the surface flows for radius^2 until it has these normals
/// [tasdizen2003]. Quadrics: of the points within 2.5 radii a quadric over their mean normal's plane,
/// weighted by a Gaussian; the base is as far from the scan as the quadric is from its middle [breckon2006].
/// All three on the same lattice.
///
/// Then the zero level of B is the base, with distances to first order B / |grad B| where they agree with
/// those to its mesh (distance/rebuild_band.h).
///
/// @param scan  distances [voxels] in a box that begins at 0: a whole object with baseMargin(radius) of void
///              around, or a texture that continues beyond the box as its last layer does
/// @throw Error InvalidOption, EmptyInput (no surface; no base is left), Memory, Cancelled
/// @par Cost    O(voxels within 5 radii of the surface * radius / step^4) for means, step being that of the
///              lattice; distances before and after O(voxels within 5 radii / 8), a fifth of a microsecond
///              each and core, twice
/// @par Repeats same bits for any number of threads
BaseSurface baseSurface(const BrickField& scan, const BaseOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
