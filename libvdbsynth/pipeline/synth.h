#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/synth/block_synthesis.h"
#include "libvdbsynth/vdb/level_set.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

struct SynthOptions {
    /// Per axis the target's size: in voxels, or as a multiple of the domain where `multiple` is set.
    std::array<double, 3> size{2, 2, 2};
    std::array<bool, 3> multiple{true, true, true};
    std::optional<IndexBox> exemplarBox;  ///< overrides the exemplar's domain
    std::array<std::optional<Border>, 3>
        border;     ///< empty: cut where a domain is recorded or given, else object
    int block = 0;  ///< see BlockSynthesisOptions
    int levels = 0;
    int drift = 0;
    SynthesisMethod method = SynthesisMethod::Default;
    bool draft = false;            ///< work at half the resolution and read the result at the full one
    GridPtr exemplarMask;          ///< sources only where this grid is active; its box is the domain unless
                                   ///< exemplarBox says another; null: everywhere
    float halfWidth = kHalfWidth;  ///< [voxels] of the result
};

/// Where everything in the result came from: what `repeat` needs, in memory.
struct SourceMap {
    PatchMap patches;           ///< on the working boxes below
    std::array<bool, 6> cut{};  ///< faces of the target that clip and cap
    IndexBox exemplarBox;  ///< exemplar's working box [its index space]: the domain, grown by the margin at
                           ///< object borders
    IndexBox exemplarDomain;
    IndexBox targetBox;  ///< target's working box
    IndexBox targetDomain;
    bool draft = false;  ///< matched at half the resolution, read without a widened band, normalised
    float band = 8;      ///< [voxels], distances were clamped there
    float halfWidth = kHalfWidth;
    double voxelSize = 1;      ///< [world] of the exemplar
    std::string exemplarHash;  ///< levelSetHash of the exemplar
};

struct SynthResult {
    LevelSet model;
    SourceMap map;
    BlockSynthesisStats stats;
};

/// More geometry like the exemplar's: the block synthesis of synth/block_synthesis.h on the contract's domain
/// and borders, the result rebuilt to a valid narrow band.
/// @throw Error InvalidOption, Unusable (block larger than the domain, ...), EmptyInput (nothing in the
/// domain), Memory, Cancelled
/// @par Repeats same bits for (exemplar, options, ctx.seed), any number of threads
SynthResult synthesize(const LevelSet& exemplar, const SynthOptions& options = {},
                       const RunContext& ctx = {});

/// Applies a source map to an exemplar: gathers, votes and rebuilds. With the run's own exemplar the result
/// is bit for bit the run's. An exemplar whose voxels are 1/k of the run's (k a whole number) gives the
/// matching finer result: its domain must be the same box of the world. The map of a draft gives full detail
/// there.
/// @throw Error ShapeMismatch (voxel size or domain do not fit the map), EmptyInput, Memory, Cancelled
LevelSet repeatSynthesis(const SourceMap& map, const LevelSet& exemplar, const RunContext& ctx = {});

/// The map as grids: `vote_source` Vec3I and `vote_weight` float on the patch lattice (indices are lattice
/// coordinates, values target-independent exemplar indices), `source` Vec3I and `exemplar` Int32 on the
/// result's band voxels inside its domain, with the metadata that readSourceMap needs.
std::vector<GridPtr> sourceMapGrids(const SourceMap& map, const openvdb::FloatGrid& result,
                                    const RunContext& ctx = {});

/// @throw Error BadData (no source map in the file, or one that contradicts itself), Io
SourceMap readSourceMap(const std::string& path, const RunContext& ctx = {});

}  // namespace vdbsynth
