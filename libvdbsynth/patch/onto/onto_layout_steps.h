#pragma once
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/patch/onto/onto_layout.h"
#include "libvdbsynth/patch/patch_candidates.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// What a patch is compared by: the columns of a square of the exemplar's lattice in the disk of a patch, and
/// their places there.
struct OntoOverlap {
    PatchOverlap columns;
    std::vector<Vec2f> at;  ///< [columns] on the disk
};

/// The steps of layOntoSurface.
class OntoLayer {
public:
    OntoLayer(const OntoSurface& surface, const PatchField& exemplar, const OntoLayoutOptions& options,
              OntoArrangement& arrangement, const RunContext& ctx);

    /// Lays the best patch around a site. Of what is known there only what is farther than `middle` from the
    /// centre is compared. @return nodes that it got
    std::size_t lay(std::uint32_t centre, double middle, double core);
    /// One round over the worst seams. @return patches that were kept
    int repair();
    /// Where to lay the next patch so that it covers an uncovered site.
    std::uint32_t centreFor(std::uint32_t uncovered);

private:
    OntoOverlap overlapOf(const SurfaceDisk& disk, double middle) const;
    std::vector<PatchPlace> continuations(const OntoOverlap& overlap, const SurfaceDisk& disk) const;
    PatchCandidate choose(const OntoOverlap& overlap, const SurfaceDisk& disk) const;
    void fit(const OntoOverlap& overlap, OntoPatch& patch) const;
    PlanePlace middleOf(const PatchPlace& place) const;
    Vec2f columnOnDisk(int i, int j) const;
    double seamOf(std::uint32_t site) const;
    bool tryRepair(std::uint32_t centre);

    const OntoSurface& mSurface;
    const PatchField& mExemplar;
    const OntoLayoutOptions& mOptions;
    OntoArrangement& mArrangement;
    const RunContext& mContext;
    SurfaceDisks mDisks;
    double mGood = 0, mRadius = 0;
};

}  // namespace vdbsynth
