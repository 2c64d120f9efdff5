#pragma once
#include "libvdbsynth/surface/direction_field.h"

#include <vector>

namespace vdbsynth {

/// An order of the surface along its directions: how far along each place lies. [voxels]
struct SweepDistance {
    std::vector<float> distance;  ///< one a shell voxel
    double cut = 0;  ///< share of neighbours between which it jumps: a field that turns around has a cut
};

/// Least squares over neighbouring shell voxels,
///     sum (s_j - s_i - (T_i + T_j)/2 . (x_j - x_i))^2,
/// in which pairs do not count whose term is more than two voxels off, since no order follows a field all the
/// way round. To begin with distances grow from one place over its neighbours, which puts the cut where
/// fronts meet; then conjugate gradients, twice.
/// @par Cost    O(voxels) a round, 120 rounds    @par Repeats same bits for any number of threads
SweepDistance sweepDistance(const SurfaceShell& shell, const std::vector<Vec3f>& tangent,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
