#include "libvdbsynth/pipeline/make.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

namespace vdbsynth {

LevelSet makeModel(const MakeOptions& options, const RunContext& ctx) {
    requireOption(options.voxelSize > 0 && options.voxelSize < 1e30, "voxel-size",
                  std::to_string(options.voxelSize), "above 0 (world)");
    const ThreadLimit limit(ctx);
    ExemplarField made = makeExemplar(options.exemplar, ctx);
    BrickField field = made.field;
    if (!made.exact) {
        // Closed at the edge of what was computed: a jump from inside to outside between inactive voxels has
        // no surface to measure from.
        const BrickField whole = closeField(made.field, made.field.box(), kAllCut, kExemplarLimit, ctx);
        const FloatGridPtr solid = scatterBricks(whole, {0, 0, 0}, 1.f, kExemplarLimit, ctx);
        const FloatGridPtr distances =
            rebuildLevelSet(*solid, kExemplarLimit, "make " + options.exemplar.kind, ctx);
        field = gatherBricks(*distances, made.field.box(), 1.f, kExemplarLimit, ctx);
    }
    LevelSet model;
    model.domain = made.domain;
    model.domainRecorded = true;
    const Index3 shift = made.exact ? Index3{0, 0, 0} : made.field.box().min;
    const BrickField closed =
        closeField(field, {made.domain.min - shift, made.domain.max - shift}, kAllCut, kHalfWidth, ctx);
    model.grid = scatterBricks(closed, shift, float(options.voxelSize), kHalfWidth, ctx);
    model.grid->setTransform(openvdb::math::Transform::createLinearTransform(options.voxelSize));
    if (model.grid->activeVoxelCount() == 0)
        throw Error(ErrorCode::EmptyInput,
                    "make " + options.exemplar.kind +
                        ": nothing in the domain; use a larger --size or another --seed");
    stampLevelSet(model);
    return model;
}

}  // namespace vdbsynth
