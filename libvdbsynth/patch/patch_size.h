#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/patch_field.h"

namespace vdbsynth {

/// How far apart a texture repeats itself.
struct PatchFeature {
    int columns = 1;       ///< [columns] the greater of both axes'
    bool repeats = false;  ///< it is a period; else the distance over which distances are correlated
};

/// From the autocorrelation of distances along x and y, the mean of each height left out:
/// c(l) = sum D(x) D(x + l) / sum D(x)^2, per pair. The period is the first maximum after the first minimum
/// that rises by at least 0.1, to over 0.2, else the first lag at which c falls under 0.2, else half the
/// exemplar.
/// @par Cost    O(nodes x columns of a side)   @par Repeats same bits for any number of threads
PatchFeature patchFeature(const PatchField& exemplar, const RunContext& ctx = {});

/// The patch's side [columns] for an exemplar: one and a half features, at least 6 columns, at most two
/// thirds of the exemplar's shorter side, so that there are places to choose from. Without a period at least
/// a quarter of that side: noise on a scan lets correlations fall sooner than what one sees is wide.
int patchSide(const PatchField& exemplar, const PatchFeature& feature);

/// [columns] of a patch, and of it what reaches over others.
struct PatchSides {
    int patch = 0, overlap = 0;
};

/// As given, or as the exemplar says: a patch of patchSide, an overlap of a third of it.
/// @param patch    [world] side; 0: as the exemplar says   @param overlap  share of the side; 0: a third
/// @throw Error Unusable (an exemplar too small for that patch, or for one of four columns), InvalidOption (a
/// patch under four columns)
/// @par Repeats as patchFeature
PatchSides patchSides(const PatchField& field, double patch, double overlap, const RunContext& ctx = {});

}  // namespace vdbsynth
