// The grids of an analogy's result: the textured models' by the map, the plain one's own under them.
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/pipeline/analogy/analogy_steps.h"
#include "libvdbsynth/vdb/attribute_transfer.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// Grids that reach beyond the target's band stay as they are; those of the band, as a mesh's colours are, are
// extended to the result's: a voxel takes what is at its foot on the plain surface.
std::vector<GridPtr> ownGrids(const BrickField& plain, const Index3& corner, const LevelSet& target,
                              const openvdb::FloatGrid& result, const RunContext& ctx) {
    LevelSet onBand = target;
    std::vector<GridPtr> whole;
    onBand.attributes.clear();
    for (const GridPtr& grid : target.attributes)
        (isBeyondBand(grid, *target.grid) ? whole : onBand.attributes).push_back(grid);
    std::vector<GridPtr> own;
    if (!onBand.attributes.empty()) {
        std::vector<MappedVoxel> voxels;
        for (auto value = result.cbeginValueOn(); value; ++value) {
            const Index3 voxel = fromCoord(value.getCoord());
            Vec3f at{float(voxel.x - corner.x), float(voxel.y - corner.y), float(voxel.z - corner.z)};
            const float distance = sampleTrilinear(plain, at);
            const Vec3f slope = sampleGradient(plain, at);
            if (std::abs(distance) > 1 && length(slope) > 0.1f) at = at - normalized(slope) * distance;
            Source source;
            source.position = cast<double>(at) + Vec3d{double(corner.x), double(corner.y), double(corner.z)};
            voxels.push_back({voxel, source});
        }
        own = transferToVoxels(voxels, {&onBand}, result, {}, ctx);
    }
    own.insert(own.end(), whole.begin(), whole.end());
    return own;
}

}  // namespace

std::vector<GridPtr> analogyAttributes(const SourceMap& map, const std::vector<const LevelSet*>& textured,
                                       const BrickField& plain, const LevelSet& target,
                                       const openvdb::FloatGrid& result, const RunContext& ctx) {
    std::vector<GridPtr> brought;
    const bool any = std::any_of(textured.begin(), textured.end(),
                                 [](const LevelSet* model) { return !model->attributes.empty(); });
    if (any) {
        noteBandOnly(textured, ctx);
        std::vector<MappedVoxel> voxels = mappedVoxels(map, result, ctx);
        // Where the mask keeps the target, its grids stay too.
        const BrickField& weight = map.analogy.weight;
        // In voxels of the map's original resolution.
        const Index3 corner = map.finer == 1 ? map.targetBox.min : coarserVoxel(map.targetBox.min, map.finer);
        if (!weight.box().empty())
            voxels.erase(std::remove_if(voxels.begin(), voxels.end(),
                                        [&](const MappedVoxel& voxel) {
                                            const Index3 at = coarserVoxel(voxel.to, map.finer);
                                            return weight.at(at - corner) <= 0;
                                        }),
                         voxels.end());
        brought = transferToVoxels(voxels, textured, result, {}, ctx);
    }
    if (target.attributes.empty()) return brought;
    return laidOver(ownGrids(plain, map.targetBox.min, target, result, ctx), brought);
}

}  // namespace vdbsynth
