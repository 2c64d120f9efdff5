#pragma once
#include "libvdbsynth/analogy/analogy_options.h"
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/pipeline/direction/direction.h"
#include "libvdbsynth/vdb/level_set.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbsynth {

/// What happens to parts of a target that are thinner than the texture is deep.
enum class ThinParts {
    Scale,  ///< the depth is scaled with the part's thickness, so that a core stays
    Keep,   ///< the texture fades out before such parts, which stay as they are
    AsIs    ///< the whole depth everywhere: parts may be cut through
};

struct AnalogyOptions {
    VolumeAnalogyOptions synthesis;
    DirectionSource direction;          ///< over the target
    DirectionSource exemplarDirection;  ///< over the plain model of each pair
    double scale = 1;     ///< of the texture, 0.25..4: 2 is twice as large in the target's voxels
    double strength = 1;  ///< 0..1: blend from the target to the result
    GridConstPtr mask;    ///< 0..1 over the target, by which strength is multiplied; null: 1
    ThinParts thin = ThinParts::Scale;
    /// A quick look: sources are searched at half the resolution, with the texture at half the size, and read
    /// at full resolution, in one sweep (`synthesis.sweeps` is not read) and at most two levels. A note says
    /// that other sweeps are not taken.
    bool draft = false;
    float halfWidth = kHalfWidth;  ///< [voxels] of the result, 1.5..100
    bool keepDirections = false;   ///< fills AnalogyResult::directions
};

struct AnalogyModelPair {
    const LevelSet* plain = nullptr;
    const LevelSet* textured = nullptr;
};

/// @throw Error InvalidOption (a field out of its range, no pairs, null models, a direction without its grid,
/// axis or strokes), ShapeMismatch (the models of a pair differ in voxels), and what
/// requireModel (vdb/level_set.h) throws
void validate(const AnalogyOptions& options, const std::vector<AnalogyModelPair>& pairs,
              const LevelSet& target);

struct AnalogyResult {
    LevelSet model;
    SourceMap map;       ///< what repeatMap (repeat.h) reads the result through
    GridPtr directions;  ///< Vec3S next to the target's surface, unit length [world]
    std::vector<AnalogyLevelStats> levels;
    std::vector<Vec3d> singularities;  ///< [world] of the target's directions
    double cut = 0;                    ///< SweepDistance::cut of the target
    float reach = 0;                   ///< [voxels] largest distance of the texture from the plain surface
};

/// plain : textured = target : result (analogy/volume_analogy.h), rebuilt to a valid narrow band; attributes
/// of the textured models are transferred, the target's own grids stay
/// as they are, under those of the same name and kind. Faces of recorded domains that a solid touches are
/// cuts: the pair continues beyond them and nothing is copied from there, and the target is capped there
/// again. Elsewhere the result may extend beyond its domain.
/// @throw Error as validate; ShapeMismatch (the models of a pair do not overlap), Unusable (a pair that is
/// too small, a texture that reaches too far from the surface, no direction possible),
/// EmptyInput, Memory, Cancelled
/// @par Cost    see makeAnalogy    @par Repeats same bits for any number of threads
AnalogyResult makeAnalogyModel(const std::vector<AnalogyModelPair>& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx = {});

/// Pairs with all that does not depend on a target: distances, directions, features and their index.
struct PreparedPairs;
/// Prepares pairs for any number of targets, such as the frames of a sequence. The grids of the models are
/// shared and must not change.
/// @param options  `synthesis`, `exemplarDirection`, `scale` and `draft` are read
/// @throw Error as makeAnalogyModel, for the pairs   @par Repeats same bits for any number of threads
std::shared_ptr<const PreparedPairs> preparePairs(const std::vector<AnalogyModelPair>& pairs,
                                                  const AnalogyOptions& options, const RunContext& ctx = {});
/// The same result as from the pairs themselves. What preparePairs read of the options is as it was then.
/// @throw Error as above; InvalidOption (another `scale` or `draft` than the pairs were prepared with)
AnalogyResult makeAnalogyModel(const PreparedPairs& pairs, const LevelSet& target,
                               const AnalogyOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
