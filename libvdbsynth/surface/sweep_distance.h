#pragma once
#include "libvdbsynth/surface/direction_field.h"

#include <vector>

namespace vdbsynth {

/// An order of the surface along its directions: the distance of each voxel along them. [voxels]
struct SweepDistance {
    std::vector<float> distance;  ///< one per shell voxel
    double cut = 0;  ///< share of neighbours between which it jumps: a field that closes on itself has a cut
};

/// Least squares over neighbouring shell voxels,
///     sum (s_j - s_i - (T_i + T_j)/2 . (x_j - x_i))^2,
/// without pairs whose residual is over two voxels, since a field that closes on itself has no order all the
/// way round. Initially distances grow from one voxel over its neighbours, which puts the cut where fronts
/// meet; then conjugate gradients, twice.
/// @par Cost    O(voxels) per round, 120 rounds    @par Repeats same bits for any number of threads
SweepDistance sweepDistance(const SurfaceShell& shell, const std::vector<Vec3f>& tangent,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
