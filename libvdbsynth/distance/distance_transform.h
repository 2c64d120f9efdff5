#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/vec3.h"

#include <vector>

namespace vdbsynth {

/// Signed distances [samples] to the surface over a whole box, negative in the solid.
struct Distances {
    Index3 size;
    std::vector<float> values;  ///< [size, x slowest]
    std::size_t index(const Index3& p) const { return latticeIndex(p, size); }
    float at(const Index3& p) const { return values[index(p)]; }
};

/// Distances everywhere from a field with valid distances near the surface only, on every
/// `coarsening`-th voxel. Every voxel within one of the surface has a foot point on it, along its
/// gradient; each sample keeps the nearest foot point of its own voxels; the nearest foot point of each
/// sample is found by lower envelopes of parabolas along z, y and x [felzenszwalb2012], centred at the
/// foot points instead of at samples.
/// @param field  [voxels] box beginning at 0, negative in the solid
/// @param band   [voxels] values with |value| below it are used unchanged
/// @param coarsening  voxels per sample, at least 1; sample i is in the middle of its voxels
/// Without a surface, all distances are the box's longest side.
/// @throw Error Memory, Cancelled
/// @par Cost    O(voxels near the surface + samples), 8 bytes per sample
/// @par Repeats same bits for any number of threads
Distances distancesToSurface(const BrickField& field, float band, int coarsening, const RunContext& ctx = {});

}  // namespace vdbsynth
