#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <functional>

namespace vdbsynth {

/// What a sparse field is made from: samples near a surface, elsewhere the sign of a winding number.
/// All places are voxels; every function may be called from many threads.
struct WindingFieldSource {
    /// True if a cube of `side` voxels has any surface in it.
    std::function<bool(const Index3& corner, int side)> hasSurface;
    std::function<double(const Index3& voxel)> winding;
    /// The values of a cube of 8 voxels, x slowest, negative inside.
    std::function<void(const Index3& corner, float* values)> fill;
};

/// A winding number this far from 1/2 is not near an opening.
inline constexpr double kWindingMargin = 0.2;

/// What a winding number's distance from 1/2 counts as where openings are closed [voxels], at most `limit`.
float openingDistance(double winding, float limit);

/// Signs of input that is not watertight: of open meshes (vdb/convert/mesh_to_level_set_soup.cpp) and of
/// points (point_field.h). A field over a box, grown to multiples of 64 voxels: cubes with surface, and those
/// where the winding number comes near 1/2, are filled, the others are -limit or limit by its sign.
/// @par Cost    one winding number or some for each cube of 64 voxels, 8 bytes for each of 8; and the fills
/// @par Repeats same bits for any number of threads
BrickField windingField(const IndexBox& box, float limit, const WindingFieldSource& source,
                        const RunContext& ctx = {});

}  // namespace vdbsynth
