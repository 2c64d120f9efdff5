#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/solid/mesh_parts.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

// Steps of meshToSolid; for the .cpp files of mesh_to_level_set only.

/// A field around faces in index space, negative inside by the winding number, its values distances [voxels]
/// near the faces; its zero level also closes openings.
/// @throw Error Unusable (most of its area encloses nothing: a sheet)
BrickField soupToField(const Mesh& indexMesh, const std::string& name, const RunContext& ctx = {});
/// The same for a sheet of a thickness [voxels].
BrickField sheetToField(const Mesh& indexMesh, double thickness, const RunContext& ctx = {});

/// The closed parts by how deep they are nested: outermost solids, their voids, solids in those and so on,
/// each mesh with its faces outward. Empty if a part is open.
std::vector<Mesh> nestedMeshes(const Mesh& mesh, const MeshParts& parts);
/// Takes a void out of a level set, or adds a solid in one. @param next  emptied
void addNested(openvdb::FloatGrid& whole, openvdb::FloatGrid& next, bool isVoid, const std::string& name);

/// A field in index space, of which only the zero level is meant, as a level set.
FloatGridPtr levelSetOf(const BrickField& field, double voxelSize, float halfWidth, const std::string& name,
                        const RunContext& ctx = {});

/// Compares a level set with what it was made from: what was lost is a warning, with what helps, and its
/// share of the surface what lostShare gives.
/// @param mesh  [voxels] of the grid's index space, its parts oriented, without duplicate faces
/// @throw Error Unusable (over half of its outer surface is lost)
void requireKept(const Mesh& mesh, openvdb::FloatGrid& grid, const std::string& name,
                 const RunContext& ctx = {});

/// The same for points: a place counts as lost farther than a voxel and its spacing from the surface.
/// @param points, spacings  [voxels] of the field
void requirePointsKept(const std::vector<Vec3f>& points, const std::vector<float>& spacings,
                       const BrickField& field, const std::string& name, const RunContext& ctx = {});

}  // namespace vdbsynth
