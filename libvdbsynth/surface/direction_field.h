#pragma once
#include "libvdbsynth/surface/surface_shell.h"

#include <vector>

namespace vdbsynth {

/// Unit tangents on a surface's shell.
struct DirectionField {
    std::vector<Vec3f> tangent;        ///< length 1, perpendicular to the normal, one per shell voxel
    std::size_t known = 0;             ///< voxels whose direction was given, not diffused
    std::vector<Vec3f> singularities;  ///< one position in each region without a continuous direction
};

/// Extends directions given in some voxels to all of them [turk2001]: given directions are projected to the
/// tangent plane and stay; the others are averaged over their neighbours in rounds, coarse to fine. Only
/// directions within 35 degrees of the surface are used: an axis that meets a surface more steeply determines
/// little there, and its projection has a singularity at every bump (53 on a bunny, 10 with the limit). On a
/// component of the surface with less than a quarter of such directions, the limit is 90 % of the sine that
/// its best quarter reaches; directions within 10 degrees of the normal are never used. A voxel is singular
/// where the mean of its own and its neighbours' directions is shorter than 0.7.
/// @param given  any length, 0 where none is given; one per shell voxel
/// @throw Error Unusable (no direction is given, or only along normals)
/// @par Cost    O(shell voxels * rounds of averaging)
/// @par Repeats same bits for any number of threads
DirectionField directionField(const SurfaceShell& shell, const std::vector<Vec3f>& given,
                              const RunContext& ctx = {});

}  // namespace vdbsynth
