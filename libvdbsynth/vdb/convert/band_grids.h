#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/vdb/level_set.h"

#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// One grid of bandGrids: a float grid of one value, or a Vec3s grid of three.
struct BandValue {
    std::string name;
    std::size_t width = 1;  ///< 1 or 3
};

/// Grids over the active voxels of a level set, all filled by one function.
/// @param read  writes the values of all grids at a position [world], one after the other; called from many
/// threads
/// @throw Error InvalidOption (a width), Cancelled
/// @par Cost    O(active voxels) calls   @par Repeats same bits for any number of threads
std::vector<GridPtr> bandGrids(const openvdb::FloatGrid& levelSet, const std::vector<BandValue>& values,
                               const std::function<void(const Vec3d& world, float* out)>& read,
                               const RunContext& ctx = {});

}  // namespace vdbsynth
