#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/vdb/level_set.h"

namespace vdbsynth {

struct PointOptions {
    double spacing = 1.0;  ///< [voxels], least distance between two points, 0.25..100
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointOptions& options);

/// Evenly spaced points on the zero level (Poisson-disk by dart throwing in a random order drawn from
/// ctx.seed), with the outward unit normals of the field.
/// @throw Error InvalidOption, EmptyInput, Cancelled
/// @par Repeats same bits for any number of threads
PointCloud levelSetToPoints(const openvdb::FloatGrid& grid, const PointOptions& options = {},
                            const RunContext& ctx = {});

}  // namespace vdbsynth
