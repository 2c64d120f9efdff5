#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_arrangement.h"
#include "libvdbsynth/patch/patch_exemplar.h"

namespace vdbsynth {

class PointSetSurface;

/// Moves all patches at once, along the plane and by fractions of a step, so that their surfaces fit best
/// where they meet. A patch that is laid against earlier ones adds its error to theirs; here errors cancel
/// where borders close a ring. With m the way from a border's place with normal n on patch k to patch l's
/// surface, the moves t minimise
///
///     sum over places (n . (m + t_l - t_k))^2 + 1e-3 (places of k) sum_k |t_k|^2,
///
/// by normal equations, twice. No patch ends up more than 1.5 steps from where it was laid.
/// @param surface, field  of the exemplar's points
/// @return [steps] the root mean square of the moves
/// @throw Error Cancelled
/// @par Cost    O(border nodes), two projections each   @par Repeats same bits for any number of threads
double alignPatches(const PatchExemplar& exemplar, const PointSetSurface& surface, const PatchField& field,
                    PatchArrangement& arrangement, const RunContext& ctx = {});

}  // namespace vdbsynth
