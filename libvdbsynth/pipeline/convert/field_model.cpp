#include "libvdbsynth/pipeline/convert/field_model_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/distance/rebuild_band.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

namespace vdbsynth {
namespace {

RebuildOptions bandOf(float halfWidth, float ownBand) {
    RebuildOptions options;
    options.halfWidth = halfWidth;
    options.keepDistances = ownBand > 0;
    if (ownBand > 0) options.band = ownBand;
    return options;
}

}  // namespace

LevelSet modelFromField(const BrickField& given, float limit, bool exact, float band, const IndexBox& domain,
                        double voxelSize, const std::string& what, const std::string& hint,
                        const RunContext& ctx) {
    // Closed at the edge of what was computed: a jump from inside to outside between constant bricks has no
    // surface to measure from.
    const BrickField distances =
        exact ? BrickField()
              : rebuiltBand(closeField(given, given.box(), kAllCut, limit, ctx), bandOf(limit, band), ctx);
    float side = 0;
    if (!exact && distances.constantIn(distances.box(), side))
        throw Error(ErrorCode::EmptyInput, what + " has no surface");
    const BrickField closed = closeField(exact ? given : distances, domain, kAllCut, kHalfWidth, ctx);
    LevelSet model;
    model.domain = domain;
    model.domainRecorded = true;
    model.grid = scatterBricks(closed, {0, 0, 0}, float(voxelSize), kHalfWidth, ctx);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
    if (model.grid->activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput, what + ": the domain is empty; " + hint);
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
