#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/sheet/sheet_points.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

struct BlendOptions {
    double kernel = 2;   ///< [spacings] of the points' surface
    double spacing = 1;  ///< [world] of the exemplar's points
    double step = 1;     ///< [world] of the nodes that rings are counted in
    bool even = true;    ///< moved points are spread evenly (points/even_sampling.h)
};

/// Rings of nodes beside a border whose points the surface depends on at those that are moved: the kernel's
/// reach and one more.
int blendSupport(const BlendOptions& options);

/// Projects points in the two rings of nodes beside borders on the surface of all points near them, where
/// that faces as they do and is under two spacings away, and drops those too near to one of another patch.
/// @param ring  [points] how many nodes each is from a border; over blendSupport: not near one
/// @throw Error Cancelled
/// @par Cost    O(points near borders)   @par Repeats same bits for any number of threads
void blendNearBorders(const std::vector<std::uint8_t>& ring, const BlendOptions& options, SheetPoints& sheet,
                      const RunContext& ctx = {});

}  // namespace vdbsynth
