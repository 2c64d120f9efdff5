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

/// Distances everywhere from a field that knows them near the surface only. Every sample within one of the
/// surface has a foot on it, down its gradient; the nearest foot of each sample is found by lower envelopes
/// of parabolas along z, y and x [felzenszwalb2012], whose centres are the feet's places, not those of
/// samples.
/// @param field  box beginning at 0, negative in the solid
/// @param scale  makes its values distances [samples]
/// @param band   [samples] where |value * scale| is under it, it is taken as it is
/// Where there is no surface, distances are the box's longest side.
/// @throw Error Memory, Cancelled
/// @par Cost    O(samples), 8 bytes each   @par Repeats same bits for any number of threads
Distances distancesToSurface(const BrickField& field, float scale, float band, const RunContext& ctx = {});

}  // namespace vdbsynth
