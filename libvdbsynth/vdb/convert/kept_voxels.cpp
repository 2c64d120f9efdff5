#include "libvdbsynth/vdb/convert/kept_voxels.h"

#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

openvdb::MaskGrid::Ptr changedVoxels(const BrickField& before, const BrickField& after, const Index3& corner,
                                     float limit) {
    const auto changed = emptyGrid<openvdb::MaskGrid>();
    auto accessor = changed->getAccessor();
    forEachVoxel(after.box(), [&](const Index3& p) {
        const float now = std::clamp(after.inside(p), -limit, limit);
        if (now != std::clamp(before.inside(p), -limit, limit)) accessor.setValueOn(toCoord(p + corner));
    });
    return changed;
}

}  // namespace

double keepUnchanged(const openvdb::FloatGrid& target, const BrickField& before, const BrickField& after,
                     const Index3& corner, float limit, float halfWidth, openvdb::FloatGrid& result,
                     const RunContext& ctx) {
    Stage stage(ctx, "keeping what did not change", 2);
    const openvdb::MaskGrid::Ptr changed = changedVoxels(before, after, corner, limit);
    stage.advance();
    openvdb::tools::dilateActiveValues(changed->tree(), int(std::ceil(halfWidth)) + 2,
                                       openvdb::tools::NN_FACE_EDGE_VERTEX, openvdb::tools::IGNORE_TILES);
    auto near = changed->getConstAccessor();
    auto write = result.getAccessor();
    std::size_t kept = 0;
    for (auto leaf = target.tree().cbeginLeaf(); leaf; ++leaf)
        for (auto voxel = leaf->cbeginValueAll(); voxel; ++voxel) {
            const openvdb::Coord at = voxel.getCoord();
            if (near.isValueOn(at)) continue;
            if (voxel.isValueOn()) {
                write.setValueOn(at, *voxel);
                ++kept;
            } else if (write.isValueOn(at)) {
                write.setValueOff(at, *voxel);
            }
        }
    stage.advance();
    return double(kept) / double(std::max<openvdb::Index64>(1, result.activeVoxelCount()));
}

}  // namespace vdbsynth
