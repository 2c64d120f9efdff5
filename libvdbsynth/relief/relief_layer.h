#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/relief/base_surface.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// What lies over a point of a base.
struct ReliefPoint {
    float height = 0;  ///< [voxels] along the base's normal, negative below it
    float slope = 1;   ///< cosine of the angle between the scan's normal there and the base's, at least 0.05
    bool folds = false;  ///< the scan is no height here: `vector` is meant
    bool lost = false;   ///< no surface along the normal that faces outward; folds too
    Vec3f vector;        ///< [voxels] to the scan's nearest point; 0 unless it folds
};

/// The height is where the line through a point of the base, along its normal, meets the scan's surface from
/// inside: the nearest such place on either side, as far as the base's distances follow the line, so that the
/// other side of a thin wall is none. It folds where the line meets the surface several times, and where
/// the surface is steeper than 75 degrees against the base. Where it does not fold both surfaces are read by
/// cubic polynomials, as trilinear values cut the crests of short waves.
/// @param foot    on the base [voxels]   @param normal  of length 1, outward
/// @par Cost    about ten reads of both fields
ReliefPoint reliefAt(const BaseSurface& base, const Vec3f& foot, const Vec3f& normal);

/// The relief of a band around a base.
struct ReliefLayer {
    VoxelTable voxels;                 ///< |distance to the base| < half-width
    std::vector<ReliefPoint> point;    ///< [voxels] over the voxel's nearest point of the base
    std::size_t folded = 0, lost = 0;  ///< voxels
};

/// The displacement from the base to the scan for every voxel within `halfWidth` of the base: base + relief
/// is the scan wherever it does not fold (relief_strength.h).
/// @param halfWidth  [voxels] at most base.reach
/// @throw Error Cancelled
/// @par Cost    O(voxels of the band), about a microsecond each and core
/// @par Repeats same bits for any number of threads
ReliefLayer reliefLayer(const BaseSurface& base, float halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
