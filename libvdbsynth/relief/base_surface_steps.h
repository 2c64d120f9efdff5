#pragma once
// What the files of base_surface and base_scale share.
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/voxel_table.h"
#include "libvdbsynth/relief/base_surface.h"
#include "libvdbsynth/surface/surface_shell.h"

#include <functional>
#include <vector>

namespace vdbsynth {

/// A smooth field on every step-th voxel: sample i lies at voxel i * step, its value is in voxels.
struct SmoothField {
    BrickField field;
    int step = 1;
};

/// Voxels between the samples that means of a radius are taken on.
int smoothingStep(double radius);

/// The samples of a lattice that cover a box which begins at 0.
IndexBox latticeBox(const IndexBox& box, int step);

/// Distances without signs [voxels] to the zero level of a field, on every step-th voxel of a box around the
/// lattice, at most `reach`: the first part of widenedDistances.
/// @param known  [voxels] where the field's own distances end
BrickField unsignedDistances(const BrickField& field, int step, float known, float reach,
                             const RunContext& ctx);

/// Distances of a field whose zero level is meant, on every step-th voxel, clamped to -reach..reach [voxels].
/// The nearest points of the surface start from the samples within 1.5 samples of it, and spread through the
/// bricks by sweeps until none changes [danielsson1980]: distances to points that lie closer than samples, so
/// too long by about 0.02 samples. Those of the field's own stay where they are good ones
/// (distance/signed_distance.h), with a step over 1 up to `band` - 1.
/// @param band  [voxels] where the field's own distances end
/// @par Cost    a fifth of a microsecond a sample   @par Repeats same bits for any number of threads
SmoothField widenedDistances(const BrickField& field, float band, int step, float reach,
                             const RunContext& ctx);

inline constexpr float kNearReach = 4;  ///< [voxels] that distances are found for on every voxel
inline constexpr int kFarStep = 2;      ///< of the lattice that farther ones are found on

/// Distances to a surface, near and far.
struct WideDistances {
    BrickField near;  ///< [voxels] to kNearReach
    SmoothField far;  ///< on every kFarStep-th voxel
};
/// widenedDistances to kNearReach on every voxel, to `reach` on the far lattice.
WideDistances wideDistances(const BrickField& field, float band, float reach, const RunContext& ctx);
/// Both on every voxel, clamped to `reach` [voxels], at most that of wideDistances.
BrickField joined(const WideDistances& wide, float reach, const RunContext& ctx);

/// [voxels] that wideDistances has to reach for latticeDistances of this step and reach.
float wideReach(int step, float reach);
/// Distances [voxels of the scan] on every step-th voxel, to `reach` voxels; with a step over 1 those near
/// the surface are means over a Gaussian of step / 2, unless edges have to stay.
SmoothField latticeDistances(const WideDistances& scan, int step, float reach, const RunContext& ctx,
                             bool means = true);
/// Every second sample of a lattice whose samples are means, as such means.
SmoothField coarserMeans(const SmoothField& means, const RunContext& ctx);

/// B of twicing, or the Gaussian mean, from latticeDistances.
SmoothField smoothedDistances(const SmoothField& distances, BaseKind kind, double radius,
                              const RunContext& ctx);

/// BaseKind::Flow: explicit steps of mean curvature flow, stable ones.
SmoothField flowedDistances(const SmoothField& distances, double radius, const RunContext& ctx);
/// BaseKind::Normals and BaseKind::Quadrics.
SmoothField distancesByNormals(const SmoothField& distances, double radius, const RunContext& ctx);
SmoothField distancesByQuadrics(const SmoothField& distances, double radius, const RunContext& ctx);

BrickField scaledField(const BrickField& field, float by, const RunContext& ctx);
/// exp(-squared / (2 radius^2))
float spreadOf(float squared, double radius);

/// Of one site of a shell.
struct ShellNeighbour {
    std::uint32_t site;
    float squared;  ///< distance of their points
};
/// Calls visit(site, all sites whose voxels are within `reach`, itself included), from many threads.
void forShellNeighbours(const SurfaceShell& shell, double reach, const RunContext& ctx,
                        const std::function<void(std::size_t, const std::vector<ShellNeighbour>&)>& visit);
/// Values of a shell at the nearest surface points of a band's voxels.
/// @param unit  distances in samples
std::vector<Vec3f> extendedOverBand(const BrickField& unit, const VoxelTable& band, const SurfaceShell& shell,
                                    const std::vector<Vec3f>& values, const RunContext& ctx);

/// The field at every voxel of a box, by cubic polynomials, clamped to -limit..limit.
BrickField refined(const SmoothField& smooth, const IndexBox& box, float limit, const RunContext& ctx);

/// |B| / |grad B| at every vertex of the scan's surface: how far from the base it is, about. [voxels]
std::vector<float> distancesFromBase(const SmoothField& smooth, const Mesh& surface, const RunContext& ctx);

/// [voxels] that the result of baseFromField reaches at most.
float largestReach(const BaseOptions& options);
/// The zero level of a smooth field, as a valid band of the base; fills the whole result.
/// @param scan  to largestReach
BaseSurface baseFromField(const WideDistances& scan, const SmoothField& smooth, const Mesh& surface,
                          const BaseOptions& options, const RunContext& ctx);

}  // namespace vdbsynth
