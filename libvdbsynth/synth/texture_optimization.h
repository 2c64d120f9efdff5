#pragma once
#include "libvdbsynth/synth/block_synthesis.h"

namespace vdbsynth {

/// More of the same geometry by texture optimization [kwatra2005], coarse to fine. The coarsest pass begins
/// with blocks laid in raster order (synthesizeBlocks). Each pass then looks, in rounds, at patches that
/// overlap fourfold along each axis: the target is the vote of all patches over a sample, and every patch
/// looks for a source that is nearer to what was voted, among its neighbours' sources moved along and places
/// drawn ever closer by [barnes2009, section 3.2]; all patches at once, each reading the sources of the round
/// before, so that their order does not matter. What the papers leave open and is decided here, by
/// measurement (docs/decisions/010-default-synthesis.md):
///  - a patch votes with (1 + cost / 0.01 voxel^2)^-2.5: where patches agree the result is a copy, where they
///    do not the best one has the say, for a mean of misplaced surfaces is no surface of the exemplar;
///  - a source used more often than the exemplar's surface would be on average costs more [kaspar2015,
///    section 3.3], so that all of the exemplar is used and shares of volume stay;
///  - a source costs a tenth less for each of the six neighbours whose source it goes on from: where costs
///    are alike, as in what is rough throughout, larger copies keep the roughness that a vote would smooth.
///  - after the last round nothing is a mean any more: seams are cut where two sides look alike (seam_cut.h),
///    and the result's map is that of the cells. Not along axes that tile and where the target is known in
///    part: there the patches' vote is the result.
/// Where options.which names an exemplar, sources of another one are not taken, by a patch's middle;
/// options.guide adds to a cost. Patches are as long as the block in the last pass, three quarters of it
/// before, and never more than half of the exemplar.
///
/// @param exemplars  as synthesizeBlocks; they are also kept as dense arrays, four bytes a voxel
/// @throw Error as synthesizeBlocks
/// @par Cost    O(patches that are not constant * rounds * log(exemplar's side)); memory 36 bytes a patch,
/// and what
///              cutSeams takes
/// @par Repeats same bits for (inputs, options, ctx.seed), any number of threads
BlockSynthesisResult optimizeTexture(const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                     const BlockSynthesisOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
