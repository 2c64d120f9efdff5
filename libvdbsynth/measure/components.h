#pragma once
#include "libvdbsynth/measure/functionals.h"
#include "libvdbsynth/measure/measures.h"
#include "libvdbsynth/measure/occupancy.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

enum class Neighbours {
    Faces = 6,  ///< what the void uses
    All = 26    ///< faces, edges and corners: what the solid uses
};

/// @par Cost    O(runs of voxels along z), memory 12 bytes a run   @par Repeats yes
Components findComponents(const Occupancy& solid, Neighbours neighbours);

/// The voxels of all parts smaller than `interiorLimit` that touch no face of the box, and of those smaller
/// than `cutLimit` that do; x slowest.   @par Cost, Repeats as findComponents
std::vector<Index3> smallParts(const Occupancy& solid, Neighbours neighbours, std::uint64_t interiorLimit,
                               std::uint64_t cutLimit);

}  // namespace vdbsynth
