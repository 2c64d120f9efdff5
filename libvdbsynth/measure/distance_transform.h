#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// Signed distances [samples] to the surface over all of a box, negative in the solid.
struct Distances {
    Index3 size;
    std::vector<float> values;  ///< [size, x slowest]
    std::size_t index(const Index3& p) const {
        return (std::size_t(p.x) * std::size_t(size.y) + std::size_t(p.y)) * std::size_t(size.z) +
               std::size_t(p.z);
    }
    float at(const Index3& p) const { return values[index(p)]; }
};

/// Distances everywhere from a field that knows them near the surface only, on every `coarsening`-th voxel.
/// Every voxel within one of the surface has a foot on it, down its gradient; each sample keeps the foot
/// nearest to it of its own voxels; the nearest foot of each sample is found by lower envelopes of parabolas
/// along z, y and x [felzenszwalb2012], whose centres are the feet's places, not those of samples.
/// @param field  [voxels] box beginning at 0, negative in the solid
/// @param band   [voxels] where |value| is under it, it is taken as it is
/// @param coarsening  voxels a sample, at least 1; sample i stands in the middle of its voxels
/// Where there is no surface, distances are the box's longest side.
/// @throw Error Memory, Cancelled
/// @par Cost    O(voxels near the surface + samples), 8 bytes a sample
/// @par Repeats same bits for any number of threads
Distances distancesToSurface(const BrickField& field, float band, int coarsening, const RunContext& ctx = {});

}  // namespace vdbsynth
