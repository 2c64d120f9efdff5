#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

namespace vdbsynth {

struct WorldBox {
    Vec3d min, max;
};

/// [world] The box of a level set's zero level, which is taken as straight between neighbouring voxels. In
/// doubles: models far from the origin keep their digits. Of a level set without a surface, zeros.
/// @par Cost     reads every active voxel once   @par Repeats  same bits for any number of threads
WorldBox surfaceBounds(const openvdb::FloatGrid& levelSet, const RunContext& ctx = {});

}  // namespace vdbsynth
