#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/grid/brick_field.h"

namespace vdbsynth {

struct CloseOptions {
    CutFaces cut{};        ///< faces of the field's box that cut through the solid
    float halfWidth = 3;   ///< [voxels] of the result's band, at least 1.5
    float band = 3;        ///< [voxels] where the field's own distances end
    double voxelSize = 1;  ///< [world]; the result is rounded as a grid in that unit is
    bool draft = false;    ///< distances of first order (normalize_band.h) in place of exact ones
};

/// What a method made, as a closed solid with a valid narrow band: capped half a voxel outside the cut faces
/// of its box and outside all of the box (close_field.h), then rebuilt (rebuild_band.h); good distances stay.
/// @param field   [voxels] negative inside
/// @param corner  of the result's voxel for the field's voxel 0
/// @return distances [voxels] in index space, over all that the band touches
/// @par Repeats same bits for any number of threads
BrickField closedBand(const BrickField& field, const Index3& corner, const CloseOptions& options,
                      const RunContext& ctx = {});

}  // namespace vdbsynth
