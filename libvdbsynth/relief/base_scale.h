#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/relief/base_surface.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A radius for a base, and what it was chosen by.
struct BaseScale {
    double radius = 0;  ///< [voxels] for BaseOptions
    bool gap = false;   ///< false: the spectrum has no gap; the radius is a 40th of the model, or the first
                        ///< larger one at which the relief's deviation is over half a voxel
    std::vector<double> radii;      ///< [voxels] that were tried, half an octave apart
    std::vector<double> deviation;  ///< [voxels] of each: root mean square of the relief that it takes off
    std::string reason;             ///< why this one, in a sentence
};

/// [voxels] the largest radius that findBaseRadius tries: a tenth of the scan's longest side, which leaves a
/// ball whole. @param longest  side [voxels]
double largestBaseRadius(double longest);

/// The radius at the gap between the spectrum of the relief and that of the shape. v(r), the variance of what
/// a base of radius r takes off (twicing), grows with r: fast while the relief goes over, hardly at all once
/// it is over whole, and fast again where the shape follows. With the growth over an octave
///     g(r) = log2(v(sqrt(2) r) / v(r / sqrt(2)))
/// the radius is the least one whose growth is within 0.25 of the smallest; below it, relief is left in the
/// base. Radii count whose relief deviates by a third of a voxel at least, which the noise of a lattice does
/// not. There is a gap if the smallest growth is under 2: the variance of a mere curved shape grows by a
/// power of the radius (a ball's by 8).
/// @param scan     as baseSurface, with baseMargin(largestBaseRadius(longest)) around a whole object
/// @param longest  side of the object or texture [voxels]
/// @throw Error EmptyInput (no surface), InvalidOption (`longest` under 1), Memory, Cancelled
/// @par Cost    distances once, to 5 radii of the widest lattice's; means of every radius on lattices of
///              about 1.4 samples a radius, so that all radii over 6 voxels cost less than the first
/// @par Repeats same bits for any number of threads
BaseScale findBaseRadius(const BrickField& scan, double longest, float band = 3, const RunContext& ctx = {});

}  // namespace vdbsynth
