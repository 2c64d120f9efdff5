#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/relief/growth/relief_distance.h"
#include "libvdbsynth/relief/growth/relief_match.h"
#include "libvdbsynth/relief/growth/relief_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

inline constexpr std::int64_t kTypicalSeed = -1;   ///< the most typical site of the sample
inline constexpr std::int64_t kRandomSeed = -2;    ///< one by the run's seed
inline constexpr std::int64_t kFlattestSite = -1;  ///< of the target, where a rigid copy fits best

struct GrownReliefOptions {
    /// [world] radius of N(t), at least 0; about the size of a feature of the relief, half a wavelength or
    /// more. 0: kSpacingsInNeighbourhood times the target's meanSpacing, which a note says.
    double neighbourhood = 0;
    double weightFalloff = 0.5;  ///< 0.05..100: sigma of w_v, a Gaussian of the distance to t, in radii
    /// [percent of the sample's sites] 0..100: eta; a match is one of so many best ones, at least one. The
    /// more, the more varied, and the rougher: of irregular relief already the best five of 5 000 differ
    /// visibly (mean SSD 1.6 to 2 times the best one's).
    double top = 0.02;
    double seedRadius = 0;                 ///< [world] of the seed patch, at least 0; 0: the neighbourhood's
    std::int64_t seedSite = kTypicalSeed;  ///< of the sample, the middle of the seed patch
    std::int64_t targetSite = kFlattestSite;  ///< of the target, where growth begins
};

inline constexpr double kSpacingsInNeighbourhood = 4;

/// @throw Error InvalidOption (a field out of its range)
void validate(const GrownReliefOptions& options);

struct GrownRelief {
    std::vector<std::uint32_t> source;  ///< [sites] site of the sample that each took its displacement from
    std::vector<Vec3f> displacement;    ///< [sites] [world] rotated to the site's frame
    std::vector<std::uint32_t> order;   ///< [sites] 0 for the first that got its displacement
    std::size_t seeds = 0;              ///< seed patches: one for each part of the target
    double neighbourhood = 0;           ///< [world] radius that was used
    /// [world^2] mean SSD / sum of w_v over the sites that grew, each at its time: what was there of N(t)
    double grownMean = 0;
    ReliefMismatch mismatch;  ///< of the whole result, where it came from (assignedMismatch)
};

/// Grows a sample's relief over a target, the synthesis of [breckon2006], exhaustive and site by site: the
/// oracle of the faster ones.
///
/// 1. A seed patch is copied: every site of the target within `seedRadius` of the first one takes the
///    displacement of the sample's site that is nearest to its place, mapped rigidly from the frame of the
///    target's site to that of the seed site.
/// 2. Of the sites without displacement the one with the most textured neighbours N(t)' is next, ties by
///    number.
/// 3. N(t)' is mapped rigidly to every site s of the sample, and eq. 1 (relief_match.h) summed there.
/// 4. One of the best `top` percent at random, keyed on seed and site, gives its displacement, rotated to
///    t's frame.
///
/// What the paper leaves open is decided so: w_v is a Gaussian of the distance to t; the most typical site
/// is the one whose patch has the mean and root mean square height nearest to the whole sample's, of
/// patches that no border cuts short; a part of the target that growth does not reach gets a seed patch of
/// its own (a note says so). Bases are mapped rigidly too, so where the two bases differ in curvature by k,
/// eq. 1 sees k r^2 / 2 at the radius r: keep that under the relief's amplitude.
///
/// @param distance       to the sample's full surface
/// @param targetTangent  the orientation field; where there is none see growAndOrient
///     (orientation_iteration.h)
/// @throw Error InvalidOption (a field out of its range, a seed that is no site), EmptyInput,
///     ShapeMismatch, Unusable (as requireReliefSites), Memory, Cancelled
/// @par Cost    O(target's sites * sample's sites * |N(t)|) at most; a bound from where neighbours came
///     from stops most sums early. From 5 000 to 5 000 sites, |N| = 50: 1 to 2 s on one core
/// @par Repeats same bits for any number of threads
GrownRelief growRelief(const ReliefSites& sample, const ReliefDistance& distance, const SurfaceSites& target,
                       const std::vector<Vec3f>& targetTangent, const GrownReliefOptions& options = {},
                       const RunContext& ctx = {});

}  // namespace vdbsynth
