#pragma once
// What the files of base_surface and base_scale share.
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/relief/base_surface.h"

namespace vdbsynth {

/// A smooth field on every step-th voxel: sample i lies at voxel i * step, its value is in voxels.
struct SmoothField {
    BrickField field;
    int step = 1;
};

/// Voxels between the samples that means of a radius are taken on.
int smoothingStep(double radius);

/// Distances [voxels of the scan] on every step-th voxel, to `reach` voxels; with a step over 1 those near
/// the surface are means over a Gaussian of step / 2.
/// @param surface  the scan's zero level, in voxels
SmoothField latticeDistances(const BrickField& scan, const Mesh& surface, int step, float reach, float band,
                             const RunContext& ctx);

/// B of twicing, or the Gaussian mean, from latticeDistances.
SmoothField smoothedDistances(const SmoothField& distances, BaseKind kind, double radius,
                              const RunContext& ctx);

/// The field at every voxel of a box, by cubic polynomials, clamped to -limit..limit.
BrickField refined(const SmoothField& smooth, const IndexBox& box, float limit, const RunContext& ctx);

/// |B| / |grad B| at every vertex of the scan's surface: how far from the base it is, about. [voxels]
std::vector<float> distancesFromBase(const SmoothField& smooth, const Mesh& surface, const RunContext& ctx);

/// The zero level of a smooth field, as a valid band of the base; fills the whole result.
BaseSurface baseFromField(const BrickField& scan, const SmoothField& smooth, const Mesh& surface,
                          const BaseOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
