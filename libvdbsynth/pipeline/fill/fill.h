#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/synth/synthesis_options.h"
#include "libvdbsynth/vdb/level_set.h"

#include <vector>

namespace vdbsynth {

struct FillOptions {
    int block =
        0;  ///< [voxels] side of the matched blocks, 4 to 256; 0: 16, or 8 where the hole is already closed
    int levels = 0;  ///< passes, 1 to 8; 0: as many as useful, one where the hole is already closed
};

/// @param exemplar  or null
/// @throw Error InvalidOption (a field out of its range, null grids), ShapeMismatch (an exemplar of other
/// voxels than the partial's), and what requireModel (vdb/level_set.h) throws
void validate(const FillOptions& options, const LevelSet& partial, const LevelSet& hole,
              const LevelSet* exemplar);

struct FillResult {
    LevelSet model;
    SourceMap map;  ///< what repeatMap (repeat.h) reads the result through; includes the hole
    BlockSynthesisStats stats;
};

/// A model with its holes filled from its surroundings or from an exemplar. The surface inside `hole` and the
/// distances in the band around it are rebuilt: voxels further than kHalfWidth from it are bit for bit those
/// of `partial`. If `partial` has both solid and void in the hole, as behind the sheet that closed a mesh,
/// that is the initial guess, and one pass adds the model's detail. If it has only one of them, as after a
/// box was cut out, the hole is empty and all passes fill it. Distances near the hole that may refer to its
/// inside are not compared. The partial's attributes stay; inside the hole they are transferred from the
/// exemplar (vdb/attribute_transfer.h).
/// @param partial   any model; a recorded domain limits both the known and the rebuilt voxels
/// @param hole      level set whose inside is to be filled; any transform of the partial's voxel size
/// @param exemplar  with the partial's voxel size and a domain; null: the partial outside the hole
/// @throw Error as validate; Unusable (hole outside the model, nothing left to fill from), Memory, Cancelled
/// @par Cost    that of optimizeTexture on the hole's box, and dense arrays of the exemplar's box
/// @par Repeats same bits for (inputs, options, ctx.seed), any number of threads
FillResult fillHoles(const LevelSet& partial, const LevelSet& hole, const LevelSet* exemplar,
                     const FillOptions& options = {}, const RunContext& ctx = {});

/// A box of the partial's voxels as a hole. @param box  both corners inclusive
/// @throw Error InvalidOption (an empty box, null grids), Memory
LevelSet boxHole(const LevelSet& partial, const IndexBox& box, const RunContext& ctx = {});

/// Balls of three voxels around every surface point that is not on a face of the partial's source mesh: the
/// sheets that closed its loops of open edges. (Balls around whole loops would merge the long cracks of a
/// scan into one hole.)
/// @throw Error Unusable (not made from a mesh, or from one without open edges, or
/// all holes under two voxels)
LevelSet holesAtOpenEdges(const LevelSet& partial, const RunContext& ctx = {});

}  // namespace vdbsynth
