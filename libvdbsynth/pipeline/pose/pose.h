#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

struct PoseOptions {
    float halfWidth = kHalfWidth;  ///< [voxels] of the posed result, 1.5..100
    float reach = 8;  ///< [voxels] farthest that the result's surface lies from the surface at rest, 0..64
    /// Grid of vectors of a posed level set that says for every voxel where it is at rest. [world]
    std::string restGrid = "rest";
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PoseOptions& options);

/// What was made of a surface at rest, carried to another pose of that surface: a texture stays where it is
/// on the surface, frame after frame. Distances are read at the places at rest (geometry/rest_map.h, or the
/// posed model's own grid of rest positions, by trilinear values) by cubic polynomials and the band is
/// rebuilt. In the pose at rest the result comes back within 0.1 voxel. Attributes are transferred, vectors
/// with a direction are turned (not by a grid of rest positions: they are left as they are, a warning says
/// so).
///
/// Of meshes `rest` and `posed` need LevelSet::source, of the same faces. A posed level set without one needs
/// the grid of rest positions among its attributes, as far around its surface as `reach` plus the half-width:
/// beyond it the posed surface itself is taken, a note says on what share of the band.
/// @param made   of `rest`   @param rest   the model at rest   @param posed  the same model in the pose
/// @throw Error InvalidOption (options, null models), ShapeMismatch (meshes of other faces), Unusable
/// (neither meshes nor a grid of rest positions), EmptyInput (nothing is left), Memory, Cancelled
/// @par Cost    some microseconds for each voxel of the posed model's band widened by `reach`
/// @par Repeats same bits for any number of threads
LevelSet poseModel(const LevelSet& made, const LevelSet& rest, const LevelSet& posed,
                   const PoseOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
