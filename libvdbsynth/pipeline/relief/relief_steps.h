#pragma once
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/math/affine.h"
#include "libvdbsynth/pipeline/relief/relief.h"
#include "libvdbsynth/relief/transfer/relief_transfer.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// The world and a field's voxels.
struct VoxelPlace {
    Affine toWorld = kIdentity;
    double voxelSize = 1;

    Vec3d world(const Vec3f& voxel) const { return transformed(toWorld, cast<double>(voxel)); }
    /// A direction of the world in voxels, of length 1; 0 stays.
    Vec3f fromWorldDirection(const Vec3d& direction) const;
};

/// @param corner  index of the grid's voxel for the field's voxel 0
VoxelPlace placeOf(const openvdb::FloatGrid& grid, const Index3& corner);

/// A target as the relief room has it.
struct PreparedTarget {
    ReliefTarget target;
    Index3 corner;
    CutFaces cut{};
    VoxelPlace place;
};

/// The sample's relief, flat.
/// @param texel  [world] of the target that a texel is wide
ReliefSample preparedSample(const ReliefSource& source, double texel, double voxelSize,
                            const ReliefOptions& options, ReliefResult& result, const RunContext& ctx);

/// Distances known for `reach`, sites, directions, labels and strengths.
PreparedTarget preparedTarget(const LevelSet& model, float reach, const ReliefLabels& labels,
                              const ReliefOptions& options, const RunContext& ctx);

/// Places and normals [voxels] as the sites of texturing [world].
TextureShape shapeAt(const std::vector<Vec3f>& point, const std::vector<Vec3f>& normal,
                     const VoxelPlace& place);

/// Wanted directions at sites: those of texturing (pipeline/texture/texture_steps.h), in voxels.
std::vector<Vec3f> directionsAt(const std::vector<Vec3f>& point, const std::vector<Vec3f>& normal,
                                const VoxelPlace& place, const DirectionSource& source,
                                const RunContext& ctx);

/// The factor that makes a whole number of periods round the target. @param period  [voxels of the target]
double fittingFactor(const ReliefTarget& target, const VoxelPlace& place, const Vec3d& axis, double period);

/// Lays a picture round the target: u by the angle about the axis, in `periods` whole pictures, v by the
/// height along it, where the surface runs along the axis; ends keep what was found. So the pattern closes
/// and has one phase.
void wrapAround(const PreparedTarget& prepared, const Vec3d& axis, double texel, double width,
                ReliefMap& map);

/// The paper's growth: the target's mesh, displaced, as a field like reliefOnTarget's.
BrickField grownOnTarget(const ReliefSample& sample, const PreparedTarget& prepared,
                         const ReliefOptions& options, ReliefResult& result, const RunContext& ctx);

}  // namespace vdbsynth
