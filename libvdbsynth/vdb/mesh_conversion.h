#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/geometry/point_cloud.h"
#include "libvdbsynth/vdb/level_set.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// Signed distance to a closed mesh, as OpenVDB's meshToLevelSet gives it (and so as vdb_tool does), with
/// a pure scale transform.
/// @param voxelSize  [world], above 0
/// @param halfWidth  [voxels], at least 1.5
/// @param name       begins the messages
/// @throw Error Unusable (the level set encloses under half of the mesh's |signed volume|, or nothing: the
///              mesh is too open), Memory (the band would need more than ctx.maxMemory), Cancelled
/// @par Cost    as OpenVDB's; memory about 20 bytes an active voxel
/// @par Repeats same bits for any number of threads
FloatGridPtr meshToLevelSet(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                            const RunContext& ctx = {});

/// What to make of a mesh that does not bound a solid.
enum class OpenMesh {
    Close,  ///< a solid: inside is where the generalised winding number is over one half
    Shell   ///< a sheet of some thickness about the faces or points, of any mesh or cloud
};

struct SolidOptions {
    OpenMesh open = OpenMesh::Close;
    double thickness = 0;  ///< [world] of a shell, above 0
    /// Distances of closed meshes as they are. Else OpenVDB smooths bumps of overlapping parts, as vdb_tool
    /// has it, which moves concave creases by up to half a voxel.
    bool exact = false;
};

/// @throw Error InvalidOption (a shell without a thickness)
void validate(const SolidOptions& options);

/// A level set of any mesh. One that bounds a solid, perhaps after vertices on one place were welded and
/// faces turned to agree, goes to meshToLevelSet. Any other (open, with edges of three faces, of one-sided
/// parts) gets its sign from the generalised winding number, closed smoothly across its openings, with a
/// warning that says what was found.
/// @throw Error InvalidOption (`thickness`), Unusable (it encloses next to nothing: a sheet), Memory,
/// Cancelled
/// @par Cost    as meshToLevelSet; with winding numbers a few microseconds for each voxel at the surface more
/// @par Repeats same bits for any number of threads
FloatGridPtr meshToSolid(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                         const SolidOptions& options = {}, const RunContext& ctx = {});

/// A level set of points: their outliers left out with a warning, normals estimated where there are none.
/// Within a few spacings of a point the surface is the moving least squares one of their tangent planes
/// [kolluri2008], in gaps it is where the winding number of the points is one half [barill2018].
/// @param cloud  [world] normals outward, or empty
/// @throw Error InvalidOption, Unusable (under 8 points), EmptyInput (they enclose nothing), Memory,
/// Cancelled
/// @par Cost    some microseconds for each voxel near a point   @par Repeats same bits for any number of
/// threads
FloatGridPtr pointsToSolid(const PointCloud& cloud, double voxelSize, double halfWidth,
                           const std::string& name, const SolidOptions& options = {},
                           const RunContext& ctx = {});

/// For meshToSolid. A field about faces in index space, negative inside by the winding number, its values
/// distances [voxels] near the faces; its zero level also closes openings. No level set yet.
/// @throw Error Unusable (most of its area has no inside: a sheet)
FloatGridPtr soupToField(const Mesh& indexMesh, const std::string& name, const RunContext& ctx = {});
/// The same for a sheet of a thickness [voxels].
FloatGridPtr sheetToField(const Mesh& indexMesh, double thickness, const RunContext& ctx = {});

struct MeshingOptions {
    double adaptivity =
        0.0;  ///< 0..1: how far flat regions may be merged; 0 keeps about two triangles a surface voxel
    bool sharp = false;            ///< keeps edges and corners (zero_level.h); not with adaptivity
    const Mesh* source = nullptr;  ///< [world] for sharp: the mesh that the level set was made from
};

/// @throw Error InvalidOption (a field out of its range, both `sharp` and `adaptivity`)
void validate(const MeshingOptions& options);

/// The zero level as a closed manifold mesh with outward faces, by one of two ways: sharp, see zero_level.h;
/// else OpenVDB's dual contouring, then two Newton steps that put each vertex on the trilinear zero level
/// (OpenVDB's own lie up to a tenth of a voxel inside curved surfaces), then sheets that touch are separated
/// (geometry/mesh.h).
/// @throw Error InvalidOption (`adaptivity`, `sharp`), EmptyInput (no zero level), Cancelled
/// @par Repeats same bits for any number of threads
Mesh levelSetToMesh(const openvdb::FloatGrid& grid, const MeshingOptions& options = {},
                    const RunContext& ctx = {});

/// Each attribute of a mesh's vertices as a grid of its name over the active voxels of a level set: a float
/// grid, or a Vec3s grid for attributes of two (z is 0) or three values. A voxel has the value at the nearest
/// place of the mesh (barycentric), where no face is near that of the nearest vertex.
/// @param mesh  [world]   @par Cost    as meshDistance (grid/mesh_distance.h)   @par Repeats same bits for
/// any number of threads
std::vector<GridPtr> attributesToGrids(const Mesh& mesh, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx = {});
/// The same of points: a voxel blends the three nearest by the inverse of their squared distances.
std::vector<GridPtr> attributesToGrids(const PointCloud& cloud, const openvdb::FloatGrid& levelSet,
                                       const RunContext& ctx = {});
/// Grids of numbers and vectors of three at places [world], by the grids' names; a vector grid "uv" gives two
/// values. Trilinear over active voxels, the background where none is. Level sets and grids of other kinds
/// are passed over.
/// @par Repeats same bits for any number of threads
Attributes gridsToAttributes(const std::vector<GridPtr>& grids, const std::vector<Vec3f>& places,
                             const RunContext& ctx = {});

struct PointOptions {
    double spacing = 1.0;  ///< [voxels], least distance between two points, 0.25..100
};

/// @throw Error InvalidOption (a field out of its range)
void validate(const PointOptions& options);

/// Evenly spaced points on the zero level (Poisson-disk by darts in a random order drawn from ctx.seed),
/// with the outward unit normals of the field.
/// @throw Error InvalidOption, EmptyInput, Cancelled
/// @par Repeats same bits for any number of threads
PointCloud levelSetToPoints(const openvdb::FloatGrid& grid, const PointOptions& options = {},
                            const RunContext& ctx = {});

}  // namespace vdbsynth
