#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/map/source_map.h"
#include "libvdbsynth/synth/synthesis_options.h"
#include "libvdbsynth/vdb/level_set.h"

#include <vector>

namespace vdbsynth {

struct FillOptions {
    int block =
        0;  ///< [voxels] side of the matched blocks, 4 to 256; 0: 16, 8 where the hole is closed already
    int levels = 0;  ///< passes, 1 to 8; 0: as many as useful, one where the hole is closed already
};

/// @param exemplar  or null
/// @throw Error InvalidOption (a field out of its range, null grids), ShapeMismatch (an exemplar of other
/// voxels than the partial's), and what requireModel (vdb/level_set.h) throws
void validate(const FillOptions& options, const LevelSet& partial, const LevelSet& hole,
              const LevelSet* exemplar);

struct FillResult {
    LevelSet model;
    SourceMap map;  ///< what repeatMap (repeat.h) reads the result through; has the hole
    BlockSynthesisStats stats;
};

/// A model whose holes are filled with more of what is around them, or of an exemplar. What is rebuilt is the
/// inside of `hole` (the surface) and the band around it (the distances): voxels further than kHalfWidth from
/// it are bit for bit those of `partial`. Where `partial` has both solid and void in the hole, as behind the
/// sheet that closed a mesh, that is the first guess, and one pass gives it the model's detail; where it has
/// but one, as after a box was cut out, nothing is known there and all passes fill it. Distances around the
/// hole that may mean what is inside do not count. What the partial carries stays; inside the hole it is read
/// from the exemplar as by carry.h.
/// @param partial   any model; a recorded domain ends what is known and what is rebuilt
/// @param hole      level set whose inside is to be filled; any transform of the partial's voxel size
/// @param exemplar  of the partial's voxel size, its domain; null: the partial outside the hole
/// @throw Error as validate; Unusable (hole outside the model, nothing left to fill from), Memory, Cancelled
/// @par Cost    that of optimizeTexture on the hole's box, and dense arrays of the exemplar's
/// @par Repeats same bits for (inputs, options, ctx.seed), any number of threads
FillResult fillHoles(const LevelSet& partial, const LevelSet& hole, const LevelSet* exemplar,
                     const FillOptions& options = {}, const RunContext& ctx = {});

/// A box of the partial's voxels as a hole. @param box  both corners inclusive
/// @throw Error InvalidOption (an empty box, null grids), Memory
LevelSet boxHole(const LevelSet& partial, const IndexBox& box, const RunContext& ctx = {});

/// Balls of three voxels round every place of the surface that is no face of the mesh that the partial was
/// made from: the sheets that closed its loops of open edges. (Balls round whole loops would take a scan with
/// long cracks for one hole.)
/// @throw Error Unusable (not made from a mesh, or from one without open edges, or all holes under two
/// voxels)
LevelSet holesAtOpenEdges(const LevelSet& partial, const RunContext& ctx = {});

}  // namespace vdbsynth
