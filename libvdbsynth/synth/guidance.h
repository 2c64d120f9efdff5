#pragma once
#include "libvdbsynth/grid/dense_field.h"
#include "libvdbsynth/synth/block_synthesis.h"

#include <vector>

namespace vdbsynth {

/// The scalars that guide one pass: sources whose exemplar scalar is close to the target's are preferred
/// [hertzmann2001, the correspondence map of texture by numbers]. Means over the eight octants of a patch are
/// compared, so that the scalar's noise has no effect.
class Guidance {
public:
    /// No guidance.
    Guidance() = default;
    /// @param target, exemplars  the scalar at the pass's scale; boxes of the pass's target and exemplars
    /// @param weight             cost [voxels^2] of a squared difference of 1
    Guidance(const BrickField& target, const std::vector<BrickField>& exemplars, float weight, int block,
             const RunContext& ctx);

    bool empty() const { return mExemplars.empty(); }
    /// [voxels^2] Guidance cost of a source position for the patch that begins at `origin`.
    float cost(const Index3& origin, std::size_t exemplar, const Index3& place) const;

private:
    BrickField mTarget;                  // means over octants
    std::vector<DenseField> mExemplars;  // the same
    float mWeight = 0;
    int mStep = 0;  // from octant to octant
};

/// The scalars at the scale of each pass, finest first, and the weight of a squared difference of 1.
struct GuideScales {
    std::vector<BrickField> target;
    std::vector<std::vector<BrickField>> exemplars;  ///< [pass][exemplar]
    float weight = 0;
};

/// @throw Error Unusable (the exemplars' scalar is constant or not finite)
GuideScales guideScales(const BlockSynthesisOptions& options, std::size_t passes, const RunContext& ctx);

}  // namespace vdbsynth
