#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/vdb/vdb_fwd.h"

#include <string>
#include <vector>

namespace vdbsynth {

/// A field of which the sign can be believed everywhere: negative inside, positive outside and beyond.
struct RepairedField {
    FloatGridPtr field;               ///< the given one where nothing was wrong
    bool measureAnew = false;         ///< only its zero level is to be believed, not its distances
    CutFaces cut{};                   ///< sides where the end of the voxels cut the solid along a plane
    float halfWidth = 3;              ///< [voxels] of the band that is to be measured anew
    std::vector<std::string> said{};  ///< what was wrong and what became of it, one part of a sentence each
};

/// Finds and repairs what other programs leave in the level sets they write: turned signs, an inside that is
/// marked outside, a background that is no distance, distances in voxels, bands that are too narrow or of two
/// widths, and solids that a clip or the end of the voxels cuts open, which are closed flat there.
/// @param grid  a level set or distances, with finite values and a linear transform; not changed
/// @throw Error Memory, Cancelled
/// @par Cost     a sound level set is read twice; repairs take some microseconds per leaf and a copy
/// @par Repeats  same bits for any number of threads
RepairedField repairedField(const FloatGridPtr& grid, const RunContext& ctx = {});

}  // namespace vdbsynth
