#pragma once
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <functional>
#include <string>

namespace vdbsynth {

/// What a grid has at a position.
struct GridReading {
    Vec3d value;          ///< a scalar is z, a truth 0 or 1
    bool active = false;  ///< of the nearest voxel
};

/// Reads a grid at world positions. Borrows the grid; from one thread, so one for each.
using GridReader = std::function<GridReading(const Vec3d& world)>;

/// How values between voxels are read.
enum class GridSampling {
    Nearest,
    Linear  ///< trilinear where values are real; whole numbers and truths are the nearest
};

/// A reader of scalars of any type. @param what  the option, for messages
/// @throw Error BadData (another kind of grid)
GridReader scalarReader(const openvdb::GridBase& grid, GridSampling sampling, const std::string& what);

/// A reader of vectors of real numbers; empty if the grid holds none.
GridReader vectorReader(const openvdb::GridBase& grid, GridSampling sampling);

/// A reader of the gradient of a scalar of real numbers, by central differences a voxel to either side [1 /
/// world]; empty if the grid holds none.
GridReader gradientReader(const openvdb::GridBase& grid);

}  // namespace vdbsynth
