#pragma once
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/coordinates/sample_features.h"

namespace vdbsynth {

/// One level of coordinate synthesis: sites, their sample's level and their coordinates.
struct CoordinateLevel {
    SurfaceSites sites;
    std::vector<Vec3f> field;         ///< [sites] the directions of +u that are wanted
    std::vector<Vec3f> tangent;       ///< [sites] those that charts have
    float leastCosine = 1;            ///< of the angle between the two
    std::vector<std::int32_t> label;  ///< [sites]
    std::vector<Vec2f> coordinate;    ///< [sites] in texels
    std::vector<SampleLevel> samples;
    double texel = 1;  ///< [world]
};

/// Every site's class: no two neighbours share one, with rare exceptions where only one of two counts the
/// other among its neighbours.
std::vector<std::uint8_t> siteClasses(const SurfaceSites& sites);

/// Corrects all coordinates `passes` times.
/// @throw Error Cancelled   @par Repeats same bits for any number of threads
void correctCoordinates(CoordinateLevel& level, int passes, const CoordinateOptions& options,
                        const RunContext& ctx = {});

/// The level's figures but the number of sites, from at most about 100 000 of them.
CoordinateLevelStats levelStats(const CoordinateLevel& level, const RunContext& ctx = {});

/// A place of the sample drawn by (seed, site, level), outside its margin.
Vec2f randomSource(const SampleLevel& sample, std::uint64_t seed, std::uint64_t site, std::uint32_t level);

}  // namespace vdbsynth
