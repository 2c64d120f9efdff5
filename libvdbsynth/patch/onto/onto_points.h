#pragma once
#include "libvdbsynth/patch/onto/onto_arrangement.h"
#include "libvdbsynth/patch/sheet/sheet_points.h"

#include <cstddef>

namespace vdbsynth {

/// How far an exemplar may bend: it is valid while 1 + h k > 0 at all its heights h, k the surface's
/// principal curvatures.
struct OntoBend {
    double folded = 0;        ///< share of the sites where it is not
    double most = 0;          ///< the greatest -h k of all but one in a hundred sites: over 1 it folds there
    std::size_t bare = 0;     ///< sites that carry nothing: parts of the surface under a few steps wide
    std::size_t dropped = 0;  ///< points left out, as the exemplar is inside out there
};

struct OntoPointsResult {
    SheetPoints sheet;  ///< places of the surface's sites' unit and origin
    BorderStats borders;
    OntoBend bend;
};

/// The exemplar's points over a surface: of every patch the points whose node is its own, that of the site
/// nearest to their foot b and of their height. A point (x, y, h) lies at b + h n, b and n the surface's
/// place and normal at its place on the disk (chart_surface.h); its normal turns with the Jacobian
/// (place_warp.h). At borders both sides are warped and blended as sheetPoints (sheet/sheet_points.h) does.
/// @param zero  [world] plane space, the height that lies on the surface itself
/// @throw Error InvalidOption (a field out of its range), Cancelled
/// @par Cost    O(points + sites x patches over them)   @par Repeats same bits for any number of threads
OntoPointsResult ontoPoints(const PatchExemplar& exemplar, const PointSetSurface& exemplarSurface,
                            const PatchField& field, const OntoSurface& surface,
                            const OntoArrangement& arrangement, double zero, const SheetOptions& options,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
