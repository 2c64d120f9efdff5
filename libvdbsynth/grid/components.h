#pragma once
#include "libvdbsynth/math/index_box.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

class Occupancy;

/// Connected components of a solid, or of a void.
struct Components {
    std::vector<std::uint64_t> sizes;     ///< [components] voxels, largest first
    std::vector<std::uint64_t> interior;  ///< sizes of those that do not touch the box's faces, largest first
};

enum class Neighbours {
    Faces = 6,  ///< the connectivity of the void
    All = 26    ///< faces, edges and corners: the connectivity of the solid
};

/// @par Cost    O(runs of voxels along z), memory 12 bytes per run   @par Repeats yes
Components findComponents(const Occupancy& solid, Neighbours neighbours);

/// The voxels of all components smaller than `interiorLimit` that touch no face of the box, and of those
/// smaller than `cutLimit` that do; x slowest.   @par Cost, Repeats as findComponents
std::vector<Index3> smallParts(const Occupancy& solid, Neighbours neighbours, std::uint64_t interiorLimit,
                               std::uint64_t cutLimit);

}  // namespace vdbsynth
