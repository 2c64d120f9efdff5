#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

// What of a surface a level set kept; every conversion and resampling ends here.

/// Compares a level set with what it was made from (solid/surface_loss.h): what was lost is a warning, with
/// what helps, and its share of the surface what lostShare (mesh_to_level_set.h) gives.
/// @param mesh  [voxels] of the grid's index space, its parts oriented, without duplicate faces
/// @param name  begins the messages
/// @throw Error Unusable (over half of its outer surface or volume is lost)
void requireKept(const Mesh& mesh, openvdb::FloatGrid& grid, const std::string& name,
                 const RunContext& ctx = {});

/// The same for points: a place counts as lost farther than a voxel and its spacing from the surface.
/// @param points, spacings  [voxels] of the field
/// @throw Error Unusable (over half of the points)
void requirePointsKept(const std::vector<Vec3f>& points, const std::vector<float>& spacings,
                       const BrickField& field, const std::string& name, const RunContext& ctx = {});

}  // namespace vdbsynth
