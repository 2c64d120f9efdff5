#include "libvdbsynth/vdb/read/surface_bounds.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/coord.h"

#include <openvdb/openvdb.h>

#include <vector>

namespace vdbsynth {

WorldBox surfaceBounds(const openvdb::FloatGrid& levelSet, const RunContext& ctx) {
    using Leaf = openvdb::FloatTree::LeafNodeType;
    constexpr std::size_t kGrain = 32;
    std::vector<const Leaf*> leaves;
    levelSet.tree().getNodes(leaves);
    std::vector<openvdb::BBoxd> parts((leaves.size() + kGrain - 1) / kGrain);
    parallelFor(ctx, leaves.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        const openvdb::FloatGrid::ConstAccessor accessor = levelSet.getConstAccessor();
        openvdb::BBoxd& box = parts[begin / kGrain];
        for (std::size_t i = begin; i < end; ++i)
            for (auto it = leaves[i]->cbeginValueOn(); it; ++it) {
                if (!(*it < 0)) continue;
                for (int face = 0; face < 6; ++face) {
                    openvdb::Coord beside = it.getCoord();
                    beside[face / 2] += face % 2 ? 1 : -1;
                    const double other = double(accessor.getValue(beside)), own = double(*it);
                    if (other < 0) continue;
                    openvdb::Vec3d at = it.getCoord().asVec3d();
                    at[face / 2] += (face % 2 ? 1 : -1) * own / (own - other);
                    box.expand(levelSet.transform().indexToWorld(at));
                }
            }
    });
    openvdb::BBoxd all;
    for (const openvdb::BBoxd& part : parts)
        if (!part.empty()) all.expand(part);
    if (all.empty()) return {};
    return {fromVec(all.min()), fromVec(all.max())};
}

}  // namespace vdbsynth
