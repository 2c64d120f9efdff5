#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cmath>

namespace vdbsynth {

/// A narrow band as bricks: what is known of a model over a domain and around it. vdb/bricks.h gathers it.
struct KnownBand {
    BrickField field;  ///< [voxels] negative inside, its box beginning at 0
    IndexBox domain;   ///< within the field's box; beyond a cut face nothing is known
    float band = 3;    ///< [voxels] where the field's distances end
};

/// [voxels] around a domain that has to be known, where a face is no cut, for a band of this half-width.
inline int reachToWiden(float halfWidth) {
    return int(std::ceil(halfWidth)) + 2;
}

/// A model over its domain as distances [voxels] clamped to [-halfWidth, halfWidth], in a field that begins
/// at 0. The band is widened by exact distances to the zero level (zero_level.h); distances of the model's
/// own stay where they are good ones (signed_distance.h). Beyond a cut face the last layer of voxels inside
/// is taken to continue, so that a block beside a cut sees material, not the cut.
/// @param known  at least reachToWiden(halfWidth) around the domain
/// @par Cost    O(voxels near the surface * halfWidth)
/// @par Repeats same bits for any number of threads
BrickField widenBand(const KnownBand& known, float halfWidth, const RunContext& ctx = {});

/// widenBand at half the resolution: a field of ceil(n/2) voxels a side, distances in its own voxels.
/// @param known  at least twice reachToWiden(halfWidth) around the domain
BrickField widenBandCoarse(const KnownBand& known, float halfWidth, const RunContext& ctx = {});

}  // namespace vdbsynth
