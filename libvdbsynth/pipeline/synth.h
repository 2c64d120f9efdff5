#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/synth/block_synthesis.h"
#include "libvdbsynth/synth/exemplar_variant.h"
#include "libvdbsynth/synth/target_size.h"
#include "libvdbsynth/vdb/level_set.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

/// What grids that come along hold in a result.
enum class CarriedValues {
    Copied,  ///< the value of the voxel that had the most say
    Blended  ///< of floats and vectors the mean of all that had a say, as much as they had
};

struct SynthOptions {
    TargetSize size = TargetSize::multiples(2, 2, 2);  ///< at least the domain, at most 1048576 voxels a side
    std::optional<IndexBox> exemplarBox;               ///< overrides the (first) exemplar's domain
    std::array<std::optional<Border>, 3>
        border;     ///< empty: cut where a domain is recorded or given, else object
    int block = 0;  ///< see BlockSynthesisOptions
    int levels = 0;
    int drift = 0;
    SynthesisMethod method = SynthesisMethod::Default;
    bool draft = false;         ///< work at half the resolution and read the result at the full one
    GridConstPtr exemplarMask;  ///< sources only where this grid is active; its box is the domain unless
                                ///< exemplarBox says another; null: everywhere; of the first exemplar
    /// Controls, read in the world of the target (guides of exemplars in theirs), see control.h; null: none.
    GridConstPtr exemplarMap;                  ///< which exemplar where; needs several
    GridConstPtr rotationMap, scaleMap;        ///< by how much what is copied is turned and scaled
    GridConstPtr guide;                        ///< a scalar by which parts of the exemplars are placed
    std::vector<GridConstPtr> exemplarGuides;  ///< the same scalar over each exemplar
    double guideWeight = 4;                    ///< 0.001 to 1000, see BlockSynthesisOptions
    double longestRun = 0.3;                   ///< 0.01 to 1, see BlockSynthesisOptions
    std::string indexCache;                    ///< BlockIndexOptions::cacheFolder; empty: none
    float halfWidth = kHalfWidth;              ///< [voxels] of the result
    CarriedValues carried = CarriedValues::Copied;
};

/// @throw Error InvalidOption (a field out of its range, fields that contradict each other, null exemplars or
/// guides), ShapeMismatch (a mask in other voxels than the exemplar's), EmptyInput (an empty mask), and what
/// requireModel (vdb/level_set.h) throws. The rest of synthesize's checks need sizes of domains and blocks;
/// they too come before any work.
void validate(const SynthOptions& options, const std::vector<const LevelSet*>& exemplars);

/// One of the exemplars that a source map reads.
struct MappedExemplar {
    IndexBox box;  ///< working box [its index space]: the domain, grown by the margin at object borders
    IndexBox domain;
    std::string hash;  ///< levelSetHash
};

/// Where everything in the result came from: what `repeat` needs, in memory.
struct SourceMap {
    PatchMap patches;           ///< on the working boxes below
    std::array<bool, 6> cut{};  ///< faces of the target that clip and cap
    std::vector<MappedExemplar> exemplars;
    std::vector<ExemplarVariant> variants;  ///< what `patches.exemplar` counts; empty: the exemplars
    IndexBox targetBox;                     ///< target's working box
    IndexBox targetDomain;
    /// [voxels] side of the blocks that were matched; those that vote may be smaller. Crumbs, which have no
    /// place in a block, are told by it.
    int matched = 16;
    bool draft = false;  ///< matched at half the resolution, read without a widened band, normalised
    float band = 8;      ///< [voxels], distances were clamped there
    float halfWidth = kHalfWidth;
    double voxelSize = 1;  ///< [world] of the exemplars
};

/// A voxel of an exemplar.
struct SourceVoxel {
    std::size_t exemplar = 0;
    Index3 voxel;                      ///< its index space
    const ExemplarVariant* variant{};  ///< that it was read through, null: none
};

/// What has the most say at a voxel of the target's domain; with a variant the nearest voxel.
SourceVoxel strongestSource(const SourceMap& map, const Index3& voxel);

/// What has a say at a voxel of the target's domain, and how much.
struct VotingSource {
    SourceVoxel from;
    float weight = 1;
};

/// All that have at least a hundredth of the strongest one's say; of a map whose first block says it, that
/// one.
std::vector<VotingSource> votingSources(const SourceMap& map, const Index3& voxel);

/// A voxel of a result and what has the most say there.
struct MappedVoxel {
    Index3 to;
    SourceVoxel from;
};

/// strongestSource of every active voxel of a result inside the map's domain.
/// @par Cost    O(active voxels * (block / stride)^3)   @par Repeats same bits for any number of threads
std::vector<MappedVoxel> strongestSources(const SourceMap& map, const openvdb::FloatGrid& result,
                                          const RunContext& ctx = {});

struct SynthResult {
    LevelSet model;
    SourceMap map;
    BlockSynthesisStats stats;
};

/// More geometry like the exemplar's: the block synthesis of synth/block_synthesis.h on the contract's domain
/// and borders, the result rebuilt to a valid narrow band.
/// The target has the first exemplar's place, voxels and multiples; along axes at 1x the others are read over
/// the first one's extent. Where maps turn or scale, exemplars are resampled once for each of at most 24
/// turns and scales, and the result is synthesis from all of those.
/// @throw Error InvalidOption, Unusable (block larger than the domain, ...), EmptyInput (nothing in the
/// domain), ShapeMismatch (exemplars of different voxel sizes), Memory, Cancelled
/// @par Repeats same bits for (exemplars, options, ctx.seed), any number of threads
SynthResult synthesize(const std::vector<const LevelSet*>& exemplars, const SynthOptions& options = {},
                       const RunContext& ctx = {});
SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options = {},
                       const RunContext& ctx = {});

/// Applies a source map to exemplars: gathers, votes and rebuilds. With the run's own exemplars the result
/// is bit for bit the run's. An exemplar whose voxels are 1/k of the run's (k a whole number) gives the
/// matching finer result: its domain must be the same box of the world. The map of a draft gives full detail
/// there.
/// @throw Error ShapeMismatch (number, voxel size or domain do not fit the map), EmptyInput, Memory,
/// Cancelled
LevelSet repeatSynthesis(const SourceMap& map, const std::vector<const LevelSet*>& exemplars,
                         const RunContext& ctx = {}, CarriedValues carried = CarriedValues::Copied);
LevelSet repeatSynthesis(const SourceMap& map, const LevelSet& exemplar, const RunContext& ctx = {});

/// The map as grids: `vote_source` Vec3I, `vote_weight` float and, of several exemplars or variants,
/// `vote_exemplar` Int32 on the patch lattice (indices are lattice coordinates, values target-independent
/// indices of the exemplar, or of the variant from 0), `source` Vec3I and `exemplar` Int32 on the result's
/// band voxels inside its domain, there also `source_rotation` Vec3S and `source_scale` float where there are
/// variants, with the metadata that readSourceMap needs.
std::vector<GridPtr> sourceMapGrids(const SourceMap& map, const openvdb::FloatGrid& result,
                                    const RunContext& ctx = {});

/// @throw Error BadData (no source map in the file, or one that contradicts itself), Io
SourceMap readSourceMap(const std::string& path, const RunContext& ctx = {});

}  // namespace vdbsynth
