#include "libvdbsynth/pipeline/field_model_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

namespace vdbsynth {

LevelSet modelFromField(const BrickField& given, float limit, bool exact, const IndexBox& domain,
                        double voxelSize, const std::string& what, const std::string& hint,
                        const RunContext& ctx) {
    const Index3 shift = exact ? Index3{0, 0, 0} : given.box().min;
    BrickField distances;
    if (!exact) {
        // Closed at the edge of what was computed: a jump from inside to outside between inactive voxels has
        // no surface to measure from.
        const BrickField whole = closeField(given, given.box(), kAllCut, limit, ctx);
        const FloatGridPtr solid = scatterBricks(whole, {0, 0, 0}, 1.f, limit, ctx);
        const FloatGridPtr rebuilt = rebuildLevelSet(*solid, limit, what, ctx);
        distances = gatherBricks(*rebuilt, given.box(), 1.f, limit, ctx);
    }
    const BrickField& field = exact ? given : distances;
    const BrickField closed =
        closeField(field, {domain.min - shift, domain.max - shift}, kAllCut, kHalfWidth, ctx);
    LevelSet model;
    model.domain = domain;
    model.domainRecorded = true;
    model.grid = scatterBricks(closed, shift, float(voxelSize), kHalfWidth, ctx);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    if (model.grid->activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, what + ": nothing in the domain; " + hint);
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
