#include "libvdbsynth/pipeline/crop.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/redistance.h"

#include <openvdb/openvdb.h>

#include <algorithm>

namespace vdbsynth {

LevelSet cropModel(const LevelSet& model, const IndexBox& box, const RunContext& ctx) {
    const ThreadLimit limit(ctx);
    requireMemory(ctx, double(box.volume()) * 8.0 / 512, "a box of " + boxText(box), "use a smaller --box");
    const double voxel = voxelSizeOf(*model.grid);
    const float band = std::max(1.5f, std::min(kHalfWidth, float(halfWidthOf(*model.grid))));
    const BrickField field = gatherBricks(*model.grid, box, float(1 / voxel), band, ctx);
    const BrickField closed = closeField(field, field.box(), kAllCut, band, ctx);
    FloatGridPtr grid = scatterBricks(closed, box.min, float(voxel), band, ctx);
    grid->setTransform(model.grid->transform().copy());
    if (grid->activeVoxelCount() == 0)
        throw Error(
            ErrorCode::EmptyInput,
            "--box " + boxText(box) + ": no surface in it; the model's domain is " + boxText(model.domain));
    LevelSet result{grid, box, true};
    stampLevelSet(result);
    return result;
}

}  // namespace vdbsynth
