#pragma once
#include "libvdbsynth/synth/block_synthesis.h"

namespace vdbsynth {

/// More of the same geometry by texture optimization [kwatra2005], coarse to fine. The coarsest pass begins
/// with blocks laid in raster order (synthesizeBlocks). Each pass then works in rounds on patches that
/// overlap fourfold along each axis: the target is the vote of all patches over a sample, and every patch
/// searches a source closer to the vote, among its neighbours' shifted sources and positions drawn from an
/// ever smaller neighbourhood [barnes2009, section 3.2]. All patches read the sources of the previous round,
/// so their order does not matter. The papers leave open the following, decided by measurement
/// (docs/decisions/010-default-synthesis.md):
///  - a patch votes with (1 + cost / 0.01 voxel^2)^-2.5: where patches agree the result is a copy; where
///    they do not the best one has the largest weight, because a mean of misplaced surfaces is not a
///    surface of the exemplar;
///  - a source used more often than average over the exemplar's surface costs more [kaspar2015, section 3.3],
///    so that all of the exemplar is used and volume fractions stay;
///  - a source costs a tenth less for each of the six neighbours whose source it continues: where costs are
///    similar, as in rough material, larger copies keep the roughness that a vote would smooth;
///  - after the last round nothing is averaged any more: seams are cut where both sides are similar
///    (seam_cut.h), and the result's map is that of the cells. Not along axes that tile or in a partly known
///    target: there the vote of the patches is the result.
/// Where options.exemplarMap sets an exemplar, by a patch's middle, sources are taken from no other;
/// options.guide adds to a cost. Patches are as long as the block in the last pass, three quarters of it
/// before, and at most half of the exemplar.
///
/// @param exemplars  as synthesizeBlocks; also copied to dense arrays, four bytes per voxel
/// @throw Error as synthesizeBlocks
/// @par Cost    O(patches that are not constant * rounds * log(exemplar's side)); memory 36 bytes per patch,
/// and that of cutSeams
/// @par Repeats same bits for (inputs, options, ctx.seed), any number of threads
BlockSynthesisResult optimizeTexture(const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                     const BlockSynthesisOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
