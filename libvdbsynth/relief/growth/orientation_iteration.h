#pragma once
#include "libvdbsynth/relief/growth/grown_relief.h"

#include <vector>

namespace vdbsynth {

struct OrientationOptions {
    double neighbourhood = 0;    ///< [world] as GrownReliefOptions'
    double weightFalloff = 0.5;  ///< as GrownReliefOptions'
    int angles = 24;  ///< 8..360: rotations of a neighbourhood that are tried, evenly over a whole turn
    /// 0..100: how much a direction across its neighbours' mean costs, as a share of what a wrong rotation
    /// costs on average.
    double smoothness = 1;
    double limit = 1;  ///< [degrees] 0.01..90: mean change of a round under which the field is consistent
    int rounds = 40;   ///< 1..1000: at most
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const OrientationOptions& options);

struct ReliefOrientation {
    std::vector<Vec3f> tangent;  ///< [sites] length 1, perpendicular to the normal
    int rounds = 0;
    double change = 0;      ///< [degrees] mean over sites, of the last round
    bool converged = true;  ///< `change` is under the limit; a warning says if not
};

/// The orientation field of a surface with relief, by iteration until it is consistent, for a sample whose
/// own is not known: the same relief, seen from the frames that are found, looks the same everywhere.
/// [breckon2006] names such an iteration but does not describe it; what follows is ours.
///
/// The patch around the most typical site (grown_relief.h) is the reference; its site's own tangent,
/// carried over the patch, orients it. For every site and angle a, D(a) is the least SSD (eq. 1) of the
/// site's displaced neighbourhood, rotated by -a, at any of the reference's sites, at most kReferences of
/// them evenly by distance. Sites then take the angle with the least D(a) / D0 + smoothness (1 - cos(a -
/// m)), with m the mean of the neighbours' tangents, as surface/direction_field.h averages them (the
/// shorter, the less it weighs), and D0 the mean excess of a rotation over a site's best one. First growing
/// outward from the reference, the site with the most oriented neighbours first, then all at once in
/// rounds, until the mean change of a round is under the limit. Where the relief prefers no direction, or
/// several, as stripes do, the neighbours decide. A note says what was found.
/// @param surface   its tangent at the reference is kept, the others are not looked at; tangents empty: the
///     smoothest field's at the reference
/// @param distance  to the surface with its relief
/// @throw Error InvalidOption, EmptyInput, ShapeMismatch, Unusable (as requireReliefSites), Memory,
///     Cancelled
/// @par Cost    O(sites * angles * kReferences * |N|) at most, once, + O(sites * angles) a round; 10 000
///     sites, |N| = 50: 4 s on one core
/// @par Repeats same bits for any number of threads
ReliefOrientation iterateOrientation(ReliefSites surface, const ReliefDistance& distance,
                                     const OrientationOptions& options = {}, const RunContext& ctx = {});

inline constexpr std::size_t kReferences = 64;

/// Grown relief and the field it was grown in.
struct OrientedRelief {
    GrownRelief relief;
    ReliefOrientation orientation;  ///< `rounds` counts growths
};

/// growRelief for a target without an orientation field: begins with the smoothest one; grows; takes for
/// every site the rotation that maps its neighbourhood best to where it and its neighbours came from,
/// smoothed as above; and grows again, until the mean change is under the limit or after kMostGrowths. The
/// growth with the least mismatch is returned. A note says what was found.
/// @param orientation  its neighbourhood and falloff are not looked at
/// @throw Error as growRelief, and InvalidOption for `orientation`
/// @par Repeats same bits for any number of threads
OrientedRelief growAndOrient(const ReliefSites& sample, const ReliefDistance& distance,
                             const SurfaceSites& target, const GrownReliefOptions& options = {},
                             const OrientationOptions& orientation = {}, const RunContext& ctx = {});

inline constexpr int kMostGrowths = 4;

/// The smoothest field of tangents over sites (surface/direction_field.h), begun along an axis.
std::vector<Vec3f> smoothestTangents(const SurfaceSites& sites, const RunContext& ctx = {});

}  // namespace vdbsynth
