#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/solid/mesh_parts.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

/// How much of a surface a level set made from it lost.
struct SurfaceLoss {
    double share = 0;                            ///< 0..1 of the outer surface's area
    double outerArea = 0;                        ///< [voxels^2] of the outer surface
    std::size_t lostSolids = 0, solids = 0;      ///< closed parts of which most is lost, and all of them
    std::size_t lostCavities = 0, cavities = 0;  ///< the same of closed voids
    std::size_t lostOpen = 0;                    ///< open parts of which most is lost
    std::size_t parts = 0;  ///< of the mesh, of all kinds; counted where something is lost
    Vec3d boxMin, boxMax;   ///< [voxels] around what is lost
    /// The level set\'s volume over the mesh\'s; 1 where the mesh\'s is not known, as its parts overlap.
    double volumeLeft = 1;
    /// [voxels] of the result, below 1: voxels of this size would keep nine tenths of what is lost. 0: none
    /// of a 256th would; it is a sheet.
    double keepingVoxel = 0;
};

/// Compares a level set with the mesh it was made from. Lost is what lies farther than about a voxel
/// from the level set's surface: farther than sqrt(1.5) from each of its crossings with the lattice's edges,
/// of which a plane at one voxel has one so near. Only the outer surface counts, where inside meets outside
/// by the winding number; faces with the solid on both sides do not, those with it on none do.
/// @param mesh    [voxels] of the result; its parts oriented (orientParts), without duplicate faces
/// @param result  the level set, negative inside, in the same index space
/// @par Cost    about a microsecond for each square voxel of the mesh, at most four million; where something
/// is
///              lost, also a winding number for each place lost
/// @par Repeats same bits for any number of threads
SurfaceLoss surfaceLoss(const Mesh& mesh, const BrickField& result, const RunContext& ctx = {});

/// [voxels] inside a field's zero level, by 64 trilinear samples in every cell that it crosses.
double enclosedVolume(const BrickField& field, const RunContext& ctx = {});

/// What was lost and what helps, as the end of a message: "37 % of its surface is lost, as ...".
/// @param voxelSize, side  [world] of the level set, and of the model's longest side
std::string lossText(const SurfaceLoss& loss, double voxelSize, double side);

/// Share of points farther from the level set's surface than about a voxel, as above, and than `reach` of
/// each.
/// @param points  [voxels]   @param reach  [voxels] as many
double pointLoss(const std::vector<Vec3f>& points, const std::vector<float>& reach, const BrickField& result,
                 const RunContext& ctx = {});

}  // namespace vdbsynth
