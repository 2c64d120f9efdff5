#include "libvdbsynth/measure/crumbs.h"

#include "libvdbsynth/measure/components.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace vdbsynth {

CrumbLimits crumbLimits(const std::vector<std::shared_ptr<const BrickField>>& exemplars, std::uint64_t most,
                        bool ofVoid, const RunContext& ctx) {
    CrumbLimits limits{most, most};
    for (const auto& exemplar : exemplars) {
        const Occupancy solid = Occupancy::fromField(*exemplar, ctx);
        const Components parts = ofVoid ? findComponents(solid.complement(), Neighbours::Faces)
                                        : findComponents(solid, Neighbours::All);
        // Sizes are sorted, so what touches a face is what is left of all without the interior ones.
        std::vector<std::uint64_t> cut;
        std::set_difference(parts.sizes.begin(), parts.sizes.end(), parts.interior.begin(),
                            parts.interior.end(), std::back_inserter(cut), std::greater<>());
        const std::vector<std::uint64_t>& interior = parts.interior;
        if (!interior.empty())
            limits.interior =
                std::min(limits.interior, interior[interior.size() - 1 - interior.size() / 100]);
        if (!cut.empty()) limits.cut = std::min(limits.cut, cut.back());
    }
    return limits;
}

std::size_t removeCrumbs(BrickField& field, const CrumbLimits& limits, bool ofVoid, const RunContext& ctx) {
    constexpr float kLeast = 0.1f;  // [voxels] so that a voxel has its new side for certain
    const Occupancy solid = Occupancy::fromField(field, ctx);
    const std::vector<Index3> crumbs =
        ofVoid ? smallParts(solid.complement(), Neighbours::Faces, limits.interior, limits.cut)
               : smallParts(solid, Neighbours::All, limits.interior, limits.cut);
    for (const Index3& p : crumbs) {
        const float depth = std::max(kLeast, std::abs(field.inside(p))), value = ofVoid ? -depth : depth;
        field.writeBox(p, {1, 1, 1}, &value);
    }
    return crumbs.size();
}

}  // namespace vdbsynth
