#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec2.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A piece of a surface laid flat: +u along the tangents of its sites, lengths as on the surface.
struct ReliefChart {
    std::vector<std::uint32_t> site;
    std::vector<Vec2f> at;  ///< [members] in the sites' unit
};

struct ReliefChartOptions {
    double differs = 0.3;  ///< [spacings] 0..1: how far the places that a site's neighbours in the chart give
                           ///< it may be from their mean; what is more would be stretched or sheared
    double maxRotation = 30;  ///< [degrees] 0..180: of the chart's u from the sites' tangents
    double overlap = 0;       ///< [sites' unit] at least 0: how far charts run into those before them
    double covered = 0.95;    ///< 0..1: share of the sites after which no more charts are laid
    std::size_t fewest = 64;  ///< sites of a chart that is kept
    std::size_t most = 256;   ///< charts
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const ReliefChartOptions& options);

/// Covers a surface with flat charts, each grown breadth first from a site: a site joins where the mean of
/// the places that its neighbours in the chart give it is within `differs` of each, by the position formula
/// of [zhang2004, appendix A] (coordinates/site_chart.h), as in coordinates/coordinate_charts.h. The first
/// chart begins at the site with the most even surroundings, of several the first; the next ones at the
/// uncovered site farthest from all covered ones. Charts overlap, so that a neighbourhood cut by one chart's
/// border is whole in another.
/// @param tangent  [sites] length 1
/// @param spacing  [sites' unit] mean distance between neighbours, above 0
/// @return charts of at least `fewest` sites, the largest one if none has so many
/// @throw Error InvalidOption, ShapeMismatch (tangents of another number), EmptyInput (no sites), Cancelled
/// @par Cost    O(sites * charts)   @par Repeats yes
std::vector<ReliefChart> layReliefCharts(const SurfaceSites& sites, const std::vector<Vec3f>& tangent,
                                         double spacing, const ReliefChartOptions& options = {},
                                         const RunContext& ctx = {});

}  // namespace vdbsynth
