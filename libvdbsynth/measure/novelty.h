#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/measure/measures.h"

#include <memory>
#include <vector>

namespace vdbsynth {

inline constexpr float kNearSurface = 1.5f;  ///< [voxels] limit of "near the surface"

/// The source of a voxel near a result's surface.
struct SourcedVoxel {
    Index3 place;   ///< in the result
    Index3 source;  ///< in its exemplar
    std::int32_t exemplar = 0;
};

/// @param voxels       those with a source, in any order, without duplicates
/// @param looked       number of voxels considered, with or without a source
/// @param result       [voxels] the result's field, for gradients
/// @param exemplar     [voxels]
/// @param exemplarBox  within the exemplar's: only its voxels within kNearSurface can be used
/// @par Cost    O(voxels log voxels + exemplar's voxels)   @par Repeats same bits for any number of threads
Novelty measureNovelty(std::vector<SourcedVoxel> voxels, std::size_t looked, const BrickField& result,
                       const BrickField& exemplar, const IndexBox& exemplarBox, const RunContext& ctx = {});

/// Share of the voxels whose value in the result is within a quarter voxel of the value at their source.
double verifiedShare(const std::vector<SourcedVoxel>& voxels, const BrickField& result,
                     const BrickField& exemplar);

/// Number of voxels in a box whose value is within `reach` of 0.
std::size_t countNearSurface(const BrickField& field, const IndexBox& box, float reach,
                             const RunContext& ctx = {});

struct MatchedSources {
    std::vector<SourcedVoxel> voxels;  ///< those of patches that are copies
    std::size_t looked = 0;            ///< voxels near the surface that were considered
    IndexBox box;                      ///< searched
};

/// Finds the sources of a result without a map: patches of 8^3 on every fourth voxel near its surface are
/// searched in the exemplar. One that differs by under a quarter voxel (root mean square) is a copy and
/// gives its source to the 4^3 voxels in its middle that are near the surface. If there are over 6000
/// such patches, only those nearest to the one nearest to the common middle are searched: one cube of
/// them, so that runs stay whole.
/// @par Repeats same bits for ctx.seed, any number of threads
MatchedSources sourcesByMatching(std::shared_ptr<const BrickField> result, const IndexBox& box,
                                 std::shared_ptr<const BrickField> exemplar, const IndexBox& exemplarBox,
                                 const RunContext& ctx = {});

}  // namespace vdbsynth
