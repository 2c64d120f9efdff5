#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/map/source_gather.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/surface/frame_field.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vdbsynth {

/// A model without and with a texture, over one box that begins at 0, distances [voxels].
struct AnalogyPair {
    std::shared_ptr<const BrickField> plain, textured;
    const FrameField* frames = nullptr;  ///< of the plain model; its finest voxels
    IndexBox inner;                      ///< what may be copied: features stay inside it
};

/// The sources of everything in a result; readAnalogy computes the result from it.
struct VolumeAnalogyResult {
    /// For every synthesised voxel, in the target's voxels: the position in its pair, in that pair's voxels,
    /// moved along the normal to the target's depth, and the rotation between their frames.
    ElementSources sources;
    std::vector<DepthRun> depths;           ///< the phase of all other voxels
    std::vector<AnalogyLevelStats> levels;  ///< coarsest first
};

/// Number of levels, at most 3, that resolve the texture. At each of them
///  - the solid differs from the finest level, beyond the plain model's own difference, by at most 1 - kHeld
///    of the texture's volume: detail that is lost at a level is not recovered at the next, and thin details
///    are lost first;
///  - every pair has at least kLeastSide voxels along two axes, of which neighbourhoods take eight.
int usefulLevels(const std::vector<AnalogyPair>& pairs, const RunContext& ctx = {});
/// Set so that grooves and dilation keep three levels and thorns one, whose figures are in
/// docs/decisions/013, step 5.
inline constexpr double kHeld = 0.7;
inline constexpr int kLeastSide = 36;  ///< [voxels of the level]

/// B' such that plain : textured = target : B' [bhat2004]: coarse to fine, voxels in the order of the sweep
/// distance; each takes the value of the voxel of the textured model with the nearest feature.
/// Beyond the paper, or left open by it:
///  - the depths that must be computed at all are read from the pairs (DepthClasses);
///  - voxels whose sweep distances are within half a voxel form a wave: they read the state before it, so a
///    wave runs on all threads and the result does not depend on their number;
///  - candidates that continue neighbours' sources come first and bound the search for the rest;
///  - the copied value is read where the source would be if its depth were exactly the target's, and after a
///    level's last sweep each voxel takes the mean of its neighbours' sources' values at its position; at the
///    finest level this is readAnalogy's.
/// @param target   box begins at 0, distances [voxels], wide enough for the added texture
/// @throw Error InvalidOption, ShapeMismatch and BadData (fields that begin elsewhere, differ in size within
/// a pair or hold NaN), Unusable (a pair too small for the levels), Cancelled
/// @par Cost    O(voxels near the surface * (samples of a feature + candidates)) per sweep
/// @par Repeats same bits for any number of threads
VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& options,
                                const RunContext& ctx = {});

/// Pairs with all that is searched of them: pyramids, features and their index. The frames of one sequence
/// share it.
struct TrainedPairs;
/// @throw Error as makeAnalogy   @par Cost  memory 100 to 200 bytes for each voxel of the pairs near the
/// surface
std::shared_ptr<const TrainedPairs> trainPairs(const std::vector<AnalogyPair>& pairs,
                                               const VolumeAnalogyOptions& options,
                                               const RunContext& ctx = {});
/// The same result as from the pairs themselves, with the options that they were trained with.
/// @throw Error as above, for the target
VolumeAnalogyResult makeAnalogy(const TrainedPairs& pairs, const BrickField& target, const FrameField& frames,
                                const RunContext& ctx = {});

inline constexpr float kAnalogyFar = 6;  ///< [voxels] distance of voxels away from the result's surface

/// The textured distance field that sources give over a target: gatherThroughSources where there are sources,
/// elsewhere kAnalogyFar times the map's factor, inside or outside by depth. Its zero level is the result;
/// away from it it is not a valid distance.
/// @param sources    positions in the coordinates of `textured`
/// @param mapBox     of the sources; the target's size divided by factor
/// @param textured   of each pair, see gatherThroughSources
/// @param target     plain distances [its voxels], box begins at 0
/// @param factor     voxels of the target along one of the map's
BrickField readAnalogy(const ElementSources& sources, const std::vector<DepthRun>& depths,
                       const IndexBox& mapBox, const std::vector<ExemplarSamples>& textured,
                       const BrickField& target, int factor = 1, const RunContext& ctx = {});

}  // namespace vdbsynth
