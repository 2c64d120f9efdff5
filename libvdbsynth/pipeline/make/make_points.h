#pragma once
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/io/texture_box.h"
#include "libvdbsynth/pipeline/make/make.h"

namespace vdbsynth {

struct MakePointsOptions {
    MakeOptions model;
    /// [voxels] least distance between two points, 0.125..100; 0: a quarter of the radius of the kind's
    /// finest rounding (ExemplarKind::detail), from 0.25 to 1
    double spacing = 0;
    /// [voxels] of geometry beyond the domain, 0..4000; negative: two thirds of the feature, a third of a
    /// patch that holds two features
    double margin = -1;
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const MakePointsOptions& options);

/// A geometry texture as points, for methods that place patches of points.
struct TexturePoints {
    PointCloud cloud;  ///< [world] with unit normals that face out of the solid
    TextureBox box;    ///< the domain, half a voxel beyond its first and last voxel's middle
};

/// Evenly spaced points on the surface of a procedural exemplar, which is neither clipped nor capped at its
/// domain: it continues for the margin, beyond which points are left out. Points lie on the surface itself,
/// not on that of its samples, with its own normals, but for foam's. The spacing may fall short by a
/// hundredth.
/// @throw Error InvalidOption, Memory, EmptyInput (no surface), Cancelled
/// @par Cost    O(points), about 24 tries for each   @par Repeats same bits for (options, ctx.seed), any
/// number of threads
TexturePoints makePoints(const MakePointsOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
