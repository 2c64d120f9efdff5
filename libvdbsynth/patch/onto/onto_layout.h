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

/// Covers a surface with round patches of an exemplar, outward from a site drawn by the seed among those
/// farthest from edges and from places where directions turn fast; a way counts 1 + (radius * turning)^2
/// times, so that calm parts come first. The next patch holds the first uncovered site, `overlap` within it;
/// of 48 such places that with the most uncovered sites of those of which at least 0.35 of the disk is known.
/// Each is chosen as layPatches (layout/patch_layout.h) does: by the fields of what lies there, seen in its
/// disk (patch_candidates.h), one of the best drawn by (seed, patch), no continuation of a patch there as
/// long as another place fits well; then moved and turned by up to 1.5 steps so that both fields fit best,
/// turned by a quarter of what fits best, so that turns do not add up around a limb; and cut in (onto_cut.h).
/// Then patches are laid over the worst seams; one that makes no sum of seams smaller is taken back.
/// @throw Error InvalidOption (a field out of its range), Unusable (a patch larger than the exemplar),
/// Memory, Cancelled
/// @par Cost    patches x (places of the exemplar x overlap) at most   @par Repeats same bits for any number
/// of threads
OntoArrangement layOntoSurface(const OntoSurface& surface, const PatchField& exemplar,
                               const OntoLayoutOptions& options, const RunContext& ctx = {});

}  // namespace vdbsynth
