#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// [voxels] What is smaller is a crumb: parts that touch no face of the box, and parts that do.
struct CrumbLimits {
    std::uint64_t interior = 0, cut = 0;
};

/// The smallest part of any exemplar (of those that touch no face the smallest hundredth), at most `most`.
/// @param ofVoid  parts of what is empty
CrumbLimits crumbLimits(const std::vector<std::shared_ptr<const BrickField>>& exemplars, std::uint64_t most,
                        bool ofVoid, const RunContext& ctx = {});

/// Gives crumbs of the solid, or of the void, the side that is around them.
/// @return voxels that changed sides   @par Repeats same bits for any number of threads
std::size_t removeCrumbs(BrickField& field, const CrumbLimits& limits, bool ofVoid,
                         const RunContext& ctx = {});

}  // namespace vdbsynth
