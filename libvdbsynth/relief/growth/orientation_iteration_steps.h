#pragma once
#include "libvdbsynth/math/vec2.h"
#include "libvdbsynth/relief/growth/orientation_iteration.h"

#include <functional>

// The steps of orientation by iteration, which two files share.
namespace vdbsynth {

/// D(a) of every site and angle, and the frames that angles are measured in.
struct RotationCosts {
    std::vector<ReliefFrame> frame;  ///< [sites]
    std::vector<Vec2f> direction;    ///< [angles] cosine and sine
    std::vector<float> cost;         ///< [sites x angles] over D0; 0 for a site's best one
};

/// @param referencesOf  sets the frames (in `matcher`) that site i is compared with; called from many
///     threads
RotationCosts rotationCosts(
    const ReliefSites& surface, const ReliefMatcher& matcher, const ReliefNeighbourhoods& neighbourhoods,
    int angles, const std::function<void(std::size_t i, std::vector<std::uint32_t>&)>& referencesOf,
    const RunContext& ctx);

/// The direction of a site for a mean of its neighbours' tangents, 0 where there is none.
Vec3f bestDirection(const RotationCosts& costs, std::size_t site, const Vec3f& mean, double smoothness);

/// The sum of the tangents of the neighbours that `known` (null: all) marks, carried to the site's tangent
/// plane, over their number.
Vec3f neighboursMean(const SurfaceSites& sites, const std::vector<Vec3f>& tangent, std::size_t site,
                     const char* known);

/// Rounds of all sites at once. @param tangent  the start, and the result
void relaxOrientation(const RotationCosts& costs, const SurfaceSites& sites,
                      const OrientationOptions& options, ReliefOrientation& result, const RunContext& ctx);

/// Mean angle between two fields. [degrees]
double meanAngle(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b);

}  // namespace vdbsynth
