#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/patch/barred_columns.h"
#include "libvdbsynth/patch/patch_field.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// The columns of a patch at which the sheet is known already, O_k, and its field there.
struct PatchOverlap {
    int nx = 0, ny = 0;  ///< columns of the whole patch
    struct Column {
        int i = 0, j = 0;  ///< in the patch
    };
    std::vector<Column> columns;
    std::vector<float> values;  ///< [columns x nz x 4]
};

/// A place of the exemplar: the first column of a patch there.
struct PatchPlace {
    int i = 0, j = 0;
};
inline bool operator==(const PatchPlace& a, const PatchPlace& b) {
    return a.i == b.i && a.j == b.j;
}

struct PatchCandidate {
    PatchPlace place;
    double cost = 0;  ///< squared distance d^2: sum over the overlap's nodes and their four values
};

struct CandidateOptions {
    double tolerance = 0.1;  ///< e >= 0
    /// Places that are left out, and those up to `exclusion` columns from them along both axes.
    std::vector<PatchPlace> excluded;
    int exclusion = 0;
    const BarredColumns* barred = nullptr;  ///< columns that no candidate may have; null: none
};

/// Psi_k [duranleau2006, section 4]: all places of the exemplar at which d <= (1 + e) min d + 1e-3 times the
/// square root of the number of values, so that a perfect match does not empty the set; d is the Euclidean
/// norm of the difference of both fields over the overlap [5.1]. Exhaustive; a place is left as soon as its
/// sum exceeds that of the best so far.
/// @return in the order of places, i then j; empty if all are excluded
/// @throw Error Unusable (a patch larger than the exemplar), Cancelled
/// @par Cost    O(places x overlap) at most    @par Repeats same bits for any number of threads
std::vector<PatchCandidate> patchCandidates(const PatchField& exemplar, const PatchOverlap& overlap,
                                            const CandidateOptions& options, const RunContext& ctx = {});

/// The mean over `probes` places of the exemplar, drawn by the seed, of d^2 over the number of values between
/// the overlap of a patch there and the best other place, one at least `apart` columns away: what a good
/// match costs in this exemplar. Infinite if there is no other place.
/// @param barred  columns that no patch may have, or null
/// @par Repeats as patchCandidates
double nearMatchLevel(const PatchField& exemplar, int patchSide, int overlapSide, int probes, int apart,
                      const RunContext& ctx = {}, const BarredColumns* barred = nullptr);

/// The overlap of a patch of the exemplar with what would lie left of it and below.
PatchOverlap ownOverlap(const PatchField& exemplar, const PatchPlace& place, int patchSide, int overlapSide);

}  // namespace vdbsynth
