#pragma once
#include "libvdbsynth/coordinates/coordinate_synthesis.h"
#include "libvdbsynth/texture/histogram_blend.h"

#include <vector>

namespace vdbsynth {

/// Where charts meet a site's colour becomes a mix of what its neighbours' charts continue to there, by
/// histogram (histogram_blend.h): its own chart weighs twice a neighbour at the mean distance and as much as
/// those that continue it, each other one as its neighbours do, by 1 / distance. Continuations within half a
/// texel are one place; the kMostBlendParts with the largest weights are mixed. Sites that all their
/// neighbours continue stay as they are.
/// @param sites    as they were synthesized, in their order; labels as there
/// @param texel    [world]
/// @param values   [sites x channels] changed
/// @param blended  [sites] set to 1 where changed
/// @return number of sites changed
/// @throw Error as HistogramBlend, Cancelled
/// @par Cost    O(sites), and the tables of each sample   @par Repeats same bits for any number of threads
std::size_t blendSeams(const CoordinateSites& sites, const CoordinateResult& coordinates,
                       const std::vector<SampleImage>& samples, double texel, std::vector<float>& values,
                       std::vector<char>& blended, const RunContext& ctx = {});

}  // namespace vdbsynth
