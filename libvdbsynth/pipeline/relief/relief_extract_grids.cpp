// A relief as grids.
#include "libvdbsynth/pipeline/relief/relief_extract_steps.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>

namespace vdbsynth {

void makeReliefGrids(ReliefExtraction& result, const ReliefLayer& layer) {
    const openvdb::FloatGrid::ConstAccessor base = result.base.grid->getConstAccessor();
    const float voxel = float(result.voxelSize);
    const auto heights = openvdb::FloatGrid::create(0.f);
    const auto vectors = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.f));
    auto heightAt = heights->getAccessor();
    auto vectorAt = vectors->getAccessor();
    const openvdb::math::Transform& transform = result.base.grid->transform();
    for (std::size_t i = 0; i < layer.point.size(); ++i) {
        if (!result.domain.contains(layer.voxels[i])) continue;
        const openvdb::Coord at = toCoord(layer.voxels[i] + result.corner);
        if (!base.isValueOn(at)) continue;
        const ReliefPoint& point = layer.point[i];
        heightAt.setValue(at, point.height * voxel);
        if (!point.folds) continue;
        const Vec3f& v = point.vector;
        // A vector of index space, in the world: the transform may rotate.
        const openvdb::Vec3d world = transform.indexToWorld(openvdb::Vec3d(v.x, v.y, v.z)) -
                                     transform.indexToWorld(openvdb::Vec3d(0.0));
        vectorAt.setValue(at, openvdb::Vec3s(world));
    }
    for (const openvdb::GridBase::Ptr& grid :
         {openvdb::GridBase::Ptr(heights), openvdb::GridBase::Ptr(vectors)})
        grid->setTransform(transform.copy());
    heights->setName("relief");
    vectors->setName("relief_vector");
    vectors->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    result.relief = heights;
    if (vectors->activeVoxelCount() > 0) result.reliefVector = vectors;
}

}  // namespace vdbsynth
