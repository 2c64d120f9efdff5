#include "libvdbsynth/grid/islands.h"

#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace vdbsynth {

IslandLimits islandLimits(const std::vector<std::shared_ptr<const BrickField>>& exemplars, std::uint64_t most,
                          bool ofVoid, const RunContext& ctx) {
    IslandLimits limits{most, most};
    for (const auto& exemplar : exemplars) {
        const Occupancy solid = Occupancy::fromField(*exemplar, ctx);
        const Components parts = ofVoid ? findComponents(solid.complement(), Neighbours::Faces)
                                        : findComponents(solid, Neighbours::All);
        // Sizes are sorted: components that touch a face are all except the interior ones.
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

std::size_t removeIslands(BrickField& field, const IslandLimits& limits, bool ofVoid, const RunContext& ctx) {
    constexpr float kLeast = 0.1f;  // [voxels] so that a voxel clearly has its new sign
    const Occupancy solid = Occupancy::fromField(field, ctx);
    const std::vector<Index3> islands =
        ofVoid ? smallParts(solid.complement(), Neighbours::Faces, limits.interior, limits.cut)
               : smallParts(solid, Neighbours::All, limits.interior, limits.cut);
    for (const Index3& p : islands) {
        const float depth = std::max(kLeast, std::abs(field.inside(p))), value = ofVoid ? -depth : depth;
        field.writeBox(p, {1, 1, 1}, &value);
    }
    return islands.size();
}

}  // namespace vdbsynth
