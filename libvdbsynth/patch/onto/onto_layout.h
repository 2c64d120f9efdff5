#pragma once
#include "libvdbsynth/patch/onto/onto_arrangement.h"

namespace vdbsynth {

/// How patches are laid over a surface. Lengths in steps of the field.
struct OntoLayoutOptions {
    int patch = 16;   ///< side of the square in the exemplar that a round patch is cut from, at least 4
    int overlap = 4;  ///< at least 1, under half of `patch`: how far a patch reaches over earlier ones
    double tolerance = 0.1;  ///< e of the candidates, 0..10
    int repairs = 2;         ///< 0..20 rounds in which patches are laid over the worst seams
};

/// Covers a surface with round patches of an exemplar, outward from a site drawn by the seed, flat parts
/// before sharply bent ones: the next patch holds the uncovered site that is nearest to the first one, ways
/// counted 1 + (radius * curvature)^2 times, and lies `overlap` within it, and covers as much
/// of what is left as one of some places around can. Each is chosen as layPatches (layout/patch_layout.h)
/// does: by the fields of what lies there, seen in its disk (patch_candidates.h), one of the best drawn by
/// (seed, patch), no continuation of a patch there as long as another place fits well; then moved and turned
/// by up to a step so that both fields fit best, and cut in (onto_cut.h). Then patches are laid over the
/// worst seams; one that makes no sum of seams smaller is taken back.
/// @param step  [world] the exemplar's, about the distance of sites
/// @throw Error InvalidOption (a field out of its range), Unusable (a patch larger than the exemplar),
/// Memory, Cancelled
/// @par Cost    patches x (places of the exemplar x overlap) at most   @par Repeats same bits for any number
/// of threads
OntoArrangement layOntoSurface(const OntoSurface& surface, const PatchField& exemplar,
                               const OntoLayoutOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
