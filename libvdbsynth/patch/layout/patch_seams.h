#pragma once
#include "libvdbsynth/patch/patch_arrangement.h"

#include <vector>

namespace vdbsynth {

/// Cost of a seam between node a of patch p and node b of patch q: |D_p(a) - D_q(a)| + |D_p(b) - D_q(b)|,
/// each clamped to +-1.5 steps and read from the exemplar; 3 for a node that the other patch's exemplar does
/// not reach.
/// @return [steps] for each column of the part that begins at (i, j), i first: the sum over pairs of its
/// nodes and the next ones along x, y and z whose patches differ
/// @par Cost    O(nodes)   @par Repeats same bits for any number of threads
std::vector<double> seamCosts(const PatchField& exemplar, const PatchArrangement& arrangement, int i, int j,
                              int nx, int ny, const RunContext& ctx = {});

}  // namespace vdbsynth
