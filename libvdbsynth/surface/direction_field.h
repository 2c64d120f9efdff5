#pragma once
#include "libvdbsynth/surface/surface_shell.h"

#include <vector>

namespace vdbsynth {

/// Unit tangents on a surface's shell.
struct DirectionField {
    std::vector<Vec3f> tangent;        ///< length 1, at right angles to the normal, one a shell voxel
    std::size_t known = 0;             ///< voxels whose direction was given, not diffused
    std::vector<Vec3f> singularities;  ///< one place in each part where no direction goes on
};

/// Directions everywhere from those given somewhere [turk2001]: what is given is turned into the tangent
/// plane and stays; the rest takes the mean of its neighbours, again and again, coarse to fine. Only what
/// is given within 35 degrees of the surface stays: an axis that meets a surface more steeply says little
/// there, and its projection has a singularity at every bump (53 on a bunny, 10 so). On a part of the surface
/// of which less than a quarter is so flat, 90 % of the sine that a quarter has is enough; within 10 degrees
/// of the normal nothing is. A place is singular where the mean of a voxel's and its neighbours' directions
/// is shorter than 0.7.
/// @param given  any length, 0 where nothing is given; one a shell voxel
/// @throw Error Unusable (nothing is given anywhere, or only along normals)
/// @par Cost    O(shell voxels * rounds of averaging)
/// @par Repeats same bits for any number of threads
DirectionField directionField(const SurfaceShell& shell, const std::vector<Vec3f>& given,
                              const RunContext& ctx = {});

}  // namespace vdbsynth
