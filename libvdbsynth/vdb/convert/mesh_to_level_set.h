#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>

namespace vdbsynth {

/// Signed distance to a closed mesh, as OpenVDB's meshToLevelSet (and so vdb_tool) computes it,
/// with a pure scale transform.
/// @param voxelSize  [world], above 0
/// @param halfWidth  [voxels], at least 1.5
/// @param name       begins the messages
/// @throw Error Unusable (the level set encloses under half of the mesh's |signed volume|, or nothing: the
///              mesh is too open), Memory (the band would need more than ctx.maxMemory), Cancelled
/// @par Cost    as OpenVDB's; memory about 20 bytes per active voxel
/// @par Repeats same bits for any number of threads
FloatGridPtr meshToLevelSet(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                            const RunContext& ctx = {});

/// How to treat a mesh that is not watertight.
enum class OpenMesh {
    Close,  ///< a solid: inside is where the generalised winding number is over one half
    Shell   ///< a sheet of some thickness around the faces or points, for any mesh or cloud
};

struct SolidOptions {
    OpenMesh open = OpenMesh::Close;
    double thickness = 0;  ///< [world] of a shell, above 0
    /// Exact distances for closed meshes, within two voxels of the surface. Else OpenVDB, as in vdb_tool,
    /// smooths the bumps of overlapping parts, which moves concave creases by up to half a voxel.
    bool exact = false;
};

/// @throw Error InvalidOption (a shell without a thickness)
void validate(const SolidOptions& options);

/// A level set of any mesh. A watertight one, if need be after coincident vertices were welded and faces
/// oriented consistently, goes to meshToLevelSet. Any other (open, with edges of three faces, with
/// non-orientable parts) gets its sign from the generalised winding number, which closes openings smoothly; a
/// warning lists what was found.
/// @throw Error InvalidOption (`thickness`), Unusable (it encloses next to nothing:
/// a sheet), Memory, Cancelled
/// @par Cost    as meshToLevelSet; winding numbers add a few microseconds for each voxel at the surface
/// @par Repeats same bits for any number of threads
FloatGridPtr meshToSolid(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                         const SolidOptions& options = {}, const RunContext& ctx = {});

/// Share of the input's outer surface that a level set of meshToSolid lost, from 0 to 1: of what was said
/// when it was made. 0 for any other grid.
double lostShare(const openvdb::FloatGrid& grid);

/// A level set of points. Outliers are left out with a warning, and missing normals are estimated. Within a
/// few spacings of a point the surface is the moving least squares surface of the tangent planes
/// [kolluri2008]; in gaps it is where the winding number of the points is one half [barill2018].
/// @param cloud  [world] normals outward, or empty
/// @throw Error InvalidOption, Unusable (under 8 points), EmptyInput (they enclose
/// nothing), Memory, Cancelled
/// @par Cost    some microseconds for each voxel near a point
/// @par Repeats same bits for any number of threads
FloatGridPtr pointsToSolid(const PointCloud& cloud, double voxelSize, double halfWidth,
                           const std::string& name, const SolidOptions& options = {},
                           const RunContext& ctx = {});

}  // namespace vdbsynth
