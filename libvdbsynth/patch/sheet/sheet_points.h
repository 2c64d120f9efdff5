#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_arrangement.h"
#include "libvdbsynth/patch/patch_exemplar.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

class PointSetSurface;

/// A sheet of geometry, plane space of its own: [0, size).
struct SheetPoints {
    std::vector<Vec3f> points, normals;  ///< [points]
    std::vector<std::uint32_t> source;   ///< [points] number of the exemplar's point that it is a copy of
    std::vector<std::int32_t> patch;     ///< [points] that brought it
    std::vector<std::uint8_t> blended;   ///< [points] 1: moved by blending at a border

    std::size_t size() const { return points.size(); }
};

struct SheetOptions {
    double reach = 0;    ///< [steps] 0..64: how far from a border a warp fades; 0: no warp
    bool blend = true;   ///< points at borders are projected on what both sides describe together
    bool even = true;    ///< and spread evenly there (points/even_sampling.h)
    double limit = 1.5;  ///< [steps] 0.1..8: two sides farther apart than that are left as they are
};

/// What became of the borders between patches.
struct BorderStats {
    std::size_t warps = 0;   ///< patches that were warped
    std::size_t shrunk = 0;  ///< of them, those whose warp was shrunk lest it folds
    double apartBefore = 0;  ///< [spacings] mean distance of both sides at the borders, before and
    double apartAfter = 0;   ///< after warping
};

struct SheetResult {
    SheetPoints sheet;
    BorderStats borders;
};

/// The exemplar's points through an arrangement: of every patch the points whose node is its own. At borders
/// both sides are warped to the middle between them (compact_warp.h): the centres are feet of border nodes on
/// the one side, spread at least a step apart, their moves half the way to the foot on the other side that
/// faces the same way. What still disagrees is blended: points within two steps of a border are projected on
/// the surface of all points there, but keep what the exemplar's own surface smooths away. A patch's warp
/// fades within `reach`, so that no error adds up.
/// @param surface  of the exemplar's points   @param field  on it, that the arrangement was made by
/// @throw Error InvalidOption (a field out of its range), Memory, Cancelled
/// @par Cost    O(points)   @par Repeats same bits for any number of threads
SheetResult sheetPoints(const PatchExemplar& exemplar, const PointSetSurface& surface,
                        const PatchField& field, const PatchArrangement& arrangement,
                        const SheetOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
