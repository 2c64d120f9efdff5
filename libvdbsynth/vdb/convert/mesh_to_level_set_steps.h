#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/solid/mesh_parts.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

// Steps of meshToSolid; for the .cpp files of mesh_to_level_set only.

struct Conversion {
    double voxelSize, halfWidth;
    const SolidOptions& options;
    const std::string& name;
    const RunContext& ctx;
};

Mesh inVoxels(const Mesh& mesh, double voxelSize);
/// @throw Error Memory (its band would need more than the context allows)
void requireBandMemory(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                       const RunContext& ctx);
/// OpenVDB's level set of a mesh that bounds a solid without voids, or null where it is not a good one.
FloatGridPtr tryOpenVdb(const Mesh& mesh, const Conversion& to);
/// A mesh as a closed solid, compared with it.
FloatGridPtr solidOf(const Mesh& mesh, const Conversion& to);

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

}  // namespace vdbsynth
