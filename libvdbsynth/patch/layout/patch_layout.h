#pragma once
#include "libvdbsynth/patch/patch_arrangement.h"

namespace vdbsynth {

/// How patches are laid. Lengths in columns of the lattice.
struct LayoutOptions {
    int patch = 16;   ///< side of a patch, at most the exemplar's
    int overlap = 4;  ///< at least 1, under `patch`: how far a patch reaches over earlier ones, at least
    double tolerance = 0.1;  ///< e of the candidates, 0..10
    bool tile = false;
    int repairs = 2;                        ///< 0..20 rounds in which patches are laid over the worst seams
    const BarredColumns* barred = nullptr;  ///< columns of the exemplar that no patch copies; null: none
};

/// Places patches over a sheet in scan-line order, each by the candidates of its overlap
/// (patch_candidates.h), one of them drawn by (seed, patch), moved by the fraction of a step that makes both
/// fields fit best, and cut into the sheet (patch_cut.h). Distances of what lies already are those of the
/// patches themselves, so that nothing has to be measured anew.
///
/// A patch that only continues an earlier one copies the exemplar in one piece. Such places are left out, as
/// long as another one costs at most twice what a good match costs in this exemplar (nearMatchLevel).
///
/// Then patches are laid over the worst seams; one that makes no sum of seams smaller is taken back.
/// @param nx, ny  columns of the sheet, at least 1; to tile, at least 4/3 of a patch
/// @throw Error InvalidOption (a field out of its range, a sheet too small to tile), Unusable (a patch larger
/// than the exemplar), Memory, Cancelled
/// @par Cost    patches x (places of the exemplar x overlap) at most   @par Repeats same bits for any number
/// of threads
PatchArrangement layPatches(const PatchField& exemplar, int nx, int ny, const LayoutOptions& options,
                            const RunContext& ctx = {});

}  // namespace vdbsynth
