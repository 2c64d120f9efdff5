#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/vdb/level_set.h"

#include <optional>
#include <vector>

namespace vdbsynth {

struct RepeatOptions {
    AttributeValues carried = AttributeValues::Copied;
    float halfWidth = 0;  ///< [voxels] of the result, 1.5..100; 0: the map's
    /// [world] of a map of a synthesis: SynthOptions::origin; none: as far from the first exemplar as in the
    /// map's run.
    std::optional<Vec3d> origin;
};

/// @throw Error InvalidOption (a field out of its range, blended values of a map whose voxels have one source
/// each, an origin for a map of another method), BadData (requireSound), ShapeMismatch (another number of
/// models than the map's), and what requireModel (vdb/level_set.h) throws
void validate(const RepeatOptions& options, const SourceMap& map, const std::vector<const LevelSet*>& inputs);

/// Applies a source map to models: gathers, votes and rebuilds, without any search. With the run's own models
/// the result is bit for bit the run's; other models in their place give the same
/// arrangement with another appearance.
///  - of a synthesis: its exemplars;
///  - of a fill: the exemplars (none if the kept model was its own), then the kept model;
///  - of an analogy: the textured model of each pair, then the target.
/// Models whose voxels are 1/k of the run's (k a whole number, 1 to 64, the same for all) give the matching
/// finer result; their domains must be the same boxes in the world. The map of a draft gives full detail in
/// the same way. A fill repeats at its own resolution only.
/// A note reports each model that is not the run's own, but for finer ones.
/// @param inputs  SourceMap::inputs() models, in this order
/// @throw Error as validate; ShapeMismatch (voxel size or domain do not fit the map),
/// EmptyInput, Memory, Cancelled
/// @par Repeats same bits for any number of threads
LevelSet repeatMap(const SourceMap& map, const std::vector<const LevelSet*>& inputs,
                   const RepeatOptions& options = {}, const RunContext& ctx = {});

}  // namespace vdbsynth
