#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/synth/synthesis_options.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbsynth {

struct BlockSynthesisOptions {
    Index3 size{
        0, 0, 0};   ///< of the target [voxels]; an axis as long as the exemplar's keeps its source coordinate
    int block = 0;  ///< N of the last pass [voxels], 4..256; 0: derived, see deriveBlock
    int levels = 0;  ///< number of passes, 1..8; 0: as many as useful, at most 3
    std::array<Border, 3> border{Border::Cut, Border::Cut, Border::Cut};
    /// Along axes that tile: voxels at each end of the target that repeat the other end, at least a block.
    /// The part between them is the tile.
    Index3 around{0, 0, 0};
    int drift = 0;  ///< [voxels] >= 0, largest distance of source and destination along axes that do not grow
    /// Axes along which the target is synthesized anew; empty: those along which it
    /// is longer than the exemplar.
    std::optional<std::array<bool, 3>> grows;
    /// For each exemplar: sources only from blocks where it is 1; box of the exemplar.
    /// Null or missing: everywhere.
    std::vector<const BrickField*> masks;
    /// The number of the exemplar for a block's source, at the block's middle, under 0 for any; box of the
    /// target. Null: any exemplar everywhere.
    const BrickField* exemplarMap = nullptr;
    /// A scalar over the target and the same scalar over every exemplar (optimizeTexture): sources with
    /// similar values are preferred. A difference of the exemplars' standard deviation throughout a block
    /// costs `guideWeight` [voxels^2]. Both or none.
    const BrickField* guide = nullptr;
    std::vector<const BrickField*> exemplarGuides;
    float guideWeight = 4;
    /// Largest share of an exemplar's patches with a surface in one verbatim piece
    /// (optimizeTexture): patches beyond it cost eight times as much, so a smaller share puts the
    /// additional seams where they cost least.
    double longestRun = 0.3;
    /// A partly known target (optimizeTexture): its samples, and 1 where they are open; boxes of the target.
    /// Sources may then come from anywhere along every axis. Both or none.
    const BrickField* known = nullptr;
    const BrickField* open = nullptr;
    bool guessed = false;    ///< the open samples of `known` are an initial guess, not empty
    std::string indexCache;  ///< BlockIndexOptions::cacheFolder; empty: none
    bool paper = false;      ///< synthesizeBlocks as in the paper; the block is then a power of two
};

struct BlockSynthesisResult {
    BrickField field;  ///< distances [voxels], the vote of all matched blocks; not yet a valid distance field
    PatchMap map;
    BlockSynthesisStats stats;
};

/// True if the target is synthesized anew along an axis along which an exemplar has `length` voxels.
bool grows(const BlockSynthesisOptions& options, int axis, int length);

/// The longest block that leaves the search a choice: half of the exemplar's shortest growing axis
/// (a quarter at an object border; all of it if the axis does not grow), even, at most 256. Under 4:
/// the exemplar is too small.
int longestBlock(const Index3& exemplar, const BlockSynthesisOptions& options);

/// The default block of the last pass: 16, or longestBlock if that is less.
/// @throw Error Unusable (the exemplar is too small for blocks of 4)
int deriveBlock(const Index3& exemplar, const BlockSynthesisOptions& options);

/// All checks that need only the exemplars' sizes, for callers with work to do before the fields exist.
/// @throw Error InvalidOption, Unusable
void validate(const BlockSynthesisOptions& options, const std::vector<Index3>& exemplars);
/// All checks of synthesizeBlocks and optimizeTexture: the same, and those of the fields.
/// @throw Error InvalidOption, Unusable, ShapeMismatch (a box that does not begin at 0, a field of another
/// size than the target or its exemplar), BadData (NaN in a field)
void validate(const BlockSynthesisOptions& options,
              const std::vector<std::shared_ptr<const BrickField>>& exemplars);

/// More of the same geometry [lagae2004, section 5], coarse to fine. Each pass works on the exemplar averaged
/// down and visits overlapping blocks in an order in which seven of a block's eight octants are done; the
/// best block of the exemplar for the known samples fills the rest. In the first pass only done samples are
/// known (a mask, where the paper pads with random samples); later passes also know the upsampled result of
/// the pass before. Blocks on one diagonal plane of the lattice do not depend on each other and are matched
/// in parallel; the result is that of the raster order. Where the paper copies octants and smooths the mesh,
/// the result here is the vote of all blocks that cover a sample (map/patch_map.h): neighbours were matched
/// to agree where they overlap, so their weighted mean has no seams. The first block of the first pass is
/// drawn from ctx.seed; of equal costs the lowest position wins.
///
/// With options.paper the paper's own method, for comparison: samples take 256 values in every pass, the
/// first pass begins with samples drawn from the exemplar and matches against them where nothing is done yet,
/// and each block fills only open samples. The paper's mesh reconstruction is not used: the result is rebuilt
/// like any other.
///
/// @param exemplars  fields of distances [voxels], clamped, boxes begin at 0, at least one
/// @throw Error InvalidOption (an option out of range), Unusable (block larger than an exemplar, object
/// border on an exemplar under four blocks), ShapeMismatch and BadData (see validate), Memory, Cancelled
/// @par Cost    O(target blocks * one search); memory: target and exemplar bricks, search index
/// @par Repeats same bits for (inputs, options, ctx.seed), any number of threads
BlockSynthesisResult synthesizeBlocks(const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                      const BlockSynthesisOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
