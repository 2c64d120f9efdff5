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
    IndexBox inner;                      ///< what may be copied: features do not reach out of it
};

/// Where everything in a result comes from; readAnalogy makes the result of it.
struct VolumeAnalogyResult {
    /// Of every voxel that was synthesised, in the target's voxels: the place in its pair, in that pair's
    /// voxels, moved along the normal to the target's own depth, and the rotation between their frames.
    ElementSources sources;
    std::vector<DepthRun> depths;           ///< what all other voxels are
    std::vector<AnalogyLevelStats> levels;  ///< coarsest first
};

/// How many levels, at most 3, still hold the texture. At each of them
///  - what is solid differs from the finest level, beyond what it does in the plain model, by at most
///    1 - kHeld of the texture's volume: what is lost at a level is not found again at the next, and thin
///    things are lost first;
///  - every pair has at least kRoom voxels along two axes, of which neighbourhoods take eight.
int usefulLevels(const std::vector<AnalogyPair>& pairs, const RunContext& ctx = {});
inline constexpr double kHeld = 0.7;
inline constexpr int kRoom = 36;  ///< [voxels of the level]

/// B' such that plain : textured = target : B' [bhat2004]: coarse to fine, voxels in the order of the sweep
/// distance, each takes the value of the voxel of the textured model whose feature is nearest.
/// Beyond the paper, or left open by it:
///  - which depths have to be worked out at all is read from the pairs (DepthClasses);
///  - voxels whose sweep distances are within half a voxel form a wave: they read what was there before it,
///  so
///    a wave runs on all threads and the result does not depend on their number;
///  - candidates that go on from what neighbours copied come first, and bound the search for the rest;
///  - the value copied is read where the source would lie if its depth were exactly the target's, and after
///    a level's last sweep each voxel takes the mean of what its neighbours' sources say about its place; at
///    the finest level that is readAnalogy's.
/// @param target   box begins at 0, distances [voxels], wide enough for what is added
/// @throw Error InvalidOption, ShapeMismatch and BadData (fields that begin elsewhere, differ in size within
/// a pair or hold NaN), Unusable (a pair too small for the levels), Cancelled
/// @par Cost    O(voxels near the surface * (samples of a feature + candidates)) a sweep
/// @par Repeats same bits for any number of threads
VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& options,
                                const RunContext& ctx = {});

inline constexpr float kAnalogyFar = 6;  ///< [voxels] of what is not near the result's surface

/// The textured distance field that sources make over a target: gatherThroughSources where there are any,
/// kAnalogyFar times the map's factor inside or outside by depth elsewhere. Its zero level is the result; it
/// is no valid distance away from it.
/// @param sources    positions as `textured` places them
/// @param mapBox     of the sources, size of the target over factor
/// @param textured   of each pair, see gatherThroughSources
/// @param target     plain distances [its voxels], box begins at 0
/// @param factor     voxels of the target along one of the map's
BrickField readAnalogy(const ElementSources& sources, const std::vector<DepthRun>& depths,
                       const IndexBox& mapBox, const std::vector<ExemplarSamples>& textured,
                       const BrickField& target, int factor = 1, const RunContext& ctx = {});

}  // namespace vdbsynth
