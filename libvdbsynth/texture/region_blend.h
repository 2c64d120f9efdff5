#pragma once
#include "libvdbsynth/coordinates/coordinate_synthesis.h"

#include <vector>

namespace vdbsynth {

/// Cross-fades colours across borders between samples. Within `width` of another label's region a site's
/// value becomes the mean of its own and of what the other sample has there: the coordinate of that label's
/// nearest site along the graph, continued (site_chart.h, flattened). With b the distance along edges to that
/// site, less half the mean distance of neighbours, the weights are s((width + b) / (2 width)) of the site's
/// own and s((width - b) / (2 width)) of the other, s(t) = t^2 (3 - 2 t): a half each on the border, 1 and 0
/// at `width`, and so continuous; where more than two meet they are divided by their sum. The site's own has
/// the largest weight, so its coordinate stays. Channels are mixed as they are: vectors in the sample's
/// frame, such as normals, are not rotated from one to the other.
/// @param sites    as they were synthesized, in their order; labels as there
/// @param texel    [world]
/// @param width    [texels] above 0
/// @param dense    samples are read between texels (readCubic), else at the nearest
/// @param values   [sites x channels] changed
/// @param blended  [sites] set to 1 where changed
/// @return number of sites changed
/// @throw Error InvalidOption (width), Cancelled
/// @par Cost    O(sites + band log band) for each label   @par Repeats same bits for any number of threads
std::size_t blendRegions(const CoordinateSites& sites, const CoordinateResult& coordinates,
                         const std::vector<SampleImage>& samples, double texel, double width, bool dense,
                         std::vector<float>& values, std::vector<char>& blended, const RunContext& ctx = {});

}  // namespace vdbsynth
