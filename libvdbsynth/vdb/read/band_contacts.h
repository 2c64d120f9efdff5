#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <cstddef>

namespace vdbsynth {

/// Active voxels of one sign with an inactive neighbour of the same sign.
struct BandSide {
    std::size_t voxels = 0;  ///< counted once per such neighbour
    std::size_t early = 0;   ///< of them, those whose band should go on beyond that neighbour
};

/// How the band of a level set meets what is inactive around it.
struct BandContacts {
    BandSide inside, outside;
    /// Neighbours of two signs, one of them inactive, that differ by more than a distance can.
    std::size_t jumps = 0;
    double deepest = 0, farthest = 0;  ///< inactive values next to the band
};

/// @param step  [unit of the values] more than neighbours of a field of distances differ by
/// @par Cost     reads every value once   @par Repeats  same bits for any number of threads
BandContacts bandContactsOf(const openvdb::FloatGrid& grid, double step, const RunContext& ctx = {});

}  // namespace vdbsynth
