#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/pipeline/direction/direction.h"
#include "libvdbsynth/synth/synthesis_options.h"
#include "libvdbsynth/synth/target_size.h"
#include "libvdbsynth/vdb/level_set.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

struct SynthOptions {
    TargetSize size = TargetSize::multiples(2, 2, 2);  ///< at least the domain, at most 1048576 voxels a side
    std::optional<IndexBox> exemplarBox;               ///< overrides the (first) exemplar's domain
    /// [world] where the minimum corner of the result's domain goes, half a voxel outside its first voxel;
    /// none: where that of the first exemplar's domain is.
    std::optional<Vec3d> origin;
    std::array<std::optional<Border>, 3>
        border;      ///< empty: cut where a domain is recorded or given, else object
    int block = 0;   ///< [voxels] side of the matched blocks, 4 to 256; 0: from the exemplar, at most 16
    int levels = 0;  ///< passes, coarse to fine, 1 to 8; 0: as many as useful
    int drift = 0;   ///< [voxels] largest distance of a source from its destination along an axis that keeps
                     ///< its length, 0 to 2^20
    SynthesisMethod method = SynthesisMethod::Default;
    bool draft = false;         ///< synthesizes at half the resolution and reads the result at the full one
    GridConstPtr exemplarMask;  ///< sources only where this grid is active, of a solid inside (maskOn, any
                                ///< voxels); its box is the domain unless exemplarBox is set; null:
                                ///< everywhere; applies to the first exemplar
    /// Controls, in the target's world space (guides of exemplars in the exemplars'); null: none.
    GridConstPtr exemplarMap;            ///< which exemplar to use where; needs several
    GridConstPtr rotationMap, scaleMap;  ///< rotation and scale of the copied geometry
    /// Instead of rotationMap: everywhere the smallest rotation from the exemplar's direction to this one.
    /// Where it is 0 nothing is rotated. Around and Radial are about the middle of the result.
    std::optional<DirectionSource> direction;
    /// Of all exemplars; must be an Axis. None: the axis recorded in the exemplar (kDirectionKey), else x.
    std::optional<DirectionSource> exemplarDirection;
    GridConstPtr guide;                        ///< a scalar that controls where parts of the exemplars go
    std::vector<GridConstPtr> exemplarGuides;  ///< the same scalar over each exemplar
    /// Cost of a guide difference of one standard deviation over the exemplars [voxels^2], 0.001 to 1000.
    double guideWeight = 4;
    double longestRun = 0.3;       ///< share of an exemplar that may be copied in one piece, 0.01 to 1
    std::string indexCache;        ///< folder that stores search indices between runs; empty: none
    float halfWidth = kHalfWidth;  ///< [voxels] of the result
    AttributeValues carried = AttributeValues::Copied;
};

/// @throw Error InvalidOption (a field out of its range, fields that contradict each other, null exemplars or
/// guides), EmptyInput (an empty mask), and what
/// requireModel (vdb/level_set.h) throws. synthesize checks the rest, which depends on domains and blocks,
/// also before any work.
void validate(const SynthOptions& options, const std::vector<const LevelSet*>& exemplars);

struct SynthResult {
    LevelSet model;
    SourceMap map;
    BlockSynthesisStats stats;
};

/// More geometry that looks like the exemplar: the block synthesis of synth/block_synthesis.h with the
/// contract's domain and borders, the result rebuilt to a valid narrow band. The target has the first
/// exemplar's position (but `origin`), voxels and multiples; along axes at 1x the other exemplars are read
/// over the first one's extent. With rotation or scale maps, exemplars are resampled for each of at most 24
/// rotations and scales, and all of those are sources.
/// @throw Error InvalidOption, Unusable (block larger than the domain, ...), EmptyInput (nothing in the
/// domain), ShapeMismatch (exemplars of different voxel sizes), Memory, Cancelled
/// @par Repeats same bits for (exemplars, options, ctx.seed), any number of threads
SynthResult synthesize(const std::vector<const LevelSet*>& exemplars, const SynthOptions& options = {},
                       const RunContext& ctx = {});
SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options = {},
                       const RunContext& ctx = {});

}  // namespace vdbsynth
