#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// [voxels] Smaller components are islands: limits for components that touch no face of the box, and that do.
struct IslandLimits {
    std::uint64_t interior = 0, cut = 0;
};

/// The smallest component of any exemplar (without contact to a face: the smallest
/// hundredth), at most `most`.
/// @param ofVoid  components of the void
IslandLimits islandLimits(const std::vector<std::shared_ptr<const BrickField>>& exemplars, std::uint64_t most,
                          bool ofVoid, const RunContext& ctx = {});

/// Flips islands of the solid, or of the void, to the surrounding phase.
/// @return number of voxels flipped   @par Repeats same bits for any number of threads
std::size_t removeIslands(BrickField& field, const IslandLimits& limits, bool ofVoid,
                          const RunContext& ctx = {});

}  // namespace vdbsynth
