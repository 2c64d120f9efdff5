#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/points/point_set_surface.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

struct EvenSamplingOptions {
    double spacing = 0;    ///< [world] wanted between neighbours; 0: the surface's median
    int rounds = 5;        ///< of repulsion, 0..100
    double tooNear = 0.5;  ///< [spacings] 0..1: a point this near to an earlier one that stays is dropped
    double tooWide = 1.5;  ///< [spacings] 1.2..10, or 0 for never: holes of the surface whose middle is
                           ///< farther than this from every point are filled
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const EvenSamplingOptions& options);

struct EvenSampling {
    std::vector<Vec3f> points, normals;  ///< [m] on the surface, its normals
    std::vector<std::uint32_t> source;   ///< [m] the input point that each was; of added ones the nearest
    std::size_t dropped = 0, added = 0;
};

/// Points on a surface, spread evenly: drops those that are too near to each other, moves the others apart
/// within their tangent planes and back on the surface [turk1992], and adds points in holes. Attributes are
/// read through `source`.
/// @param points   [n] finite, near the surface    @param normals  [n] length 1
/// @param fixed    [n], or empty: other than 0 for points that stay as they are, bit for bit
/// @return the points that stay in the order of the input, then those that were added. Points without a
/// surface near them stay where they are.
/// @throw Error InvalidOption, ShapeMismatch (arrays of different lengths), Cancelled
/// @par Cost    O(n log n), some microseconds for each point and round
/// @par Repeats same bits for any number of threads
EvenSampling evenSampling(const PointSetSurface& surface, const std::vector<Vec3f>& points,
                          const std::vector<Vec3f>& normals, const std::vector<char>& fixed = {},
                          const EvenSamplingOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
