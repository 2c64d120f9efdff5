#pragma once
#include "libvdbsynth/patch/layout/patch_layout.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// The steps of layPatches.
class PatchLayer {
public:
    PatchLayer(const PatchField& exemplar, const LayoutOptions& options, PatchArrangement& arrangement,
               const RunContext& ctx);

    /// Lays the best patch of nx x ny columns at a place. Of what is known there only columns in a rim of the
    /// patch are compared. @return its number
    std::int32_t lay(const PatchPlace& at, int nx, int ny, int rim, int core);
    /// One round over the worst seams. @return patches that were kept
    int repair();

private:
    PatchOverlap overlapAt(const PatchPlace& at, int nx, int ny, int rim) const;
    std::vector<PatchPlace> continuations(const PatchPlace& at, const PatchOverlap& overlap) const;
    PatchCandidate choose(const PatchPlace& at, const PatchOverlap& overlap) const;
    Vec3d fineMove(const PatchPlace& from, const PatchOverlap& overlap) const;
    bool tryRepair(const PatchPlace& at);

    const PatchField& mExemplar;
    const LayoutOptions& mOptions;
    PatchArrangement& mArrangement;
    const RunContext& mContext;
    double mGood = 0;
};

}  // namespace vdbsynth
