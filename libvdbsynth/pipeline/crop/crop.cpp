#include "libvdbsynth/pipeline/crop/crop.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/Clip.h>

#include <algorithm>

namespace vdbsynth {
namespace {

// A grid of any kind without the part outside a box of the model's voxels; unchanged if it cannot be clipped.
GridPtr clipped(const GridPtr& grid, const openvdb::FloatGrid& model, const IndexBox& box,
                const RunContext& ctx) {
    const auto corner = [](const Index3& p, double by) {
        return openvdb::Vec3d(p.x + by, p.y + by, p.z + by);
    };
    // OpenVDB rounds both corners down.
    const openvdb::BBoxd inside(corner(box.min, 0.01), corner(box.max, 0.49));
    const openvdb::BBoxd world = model.transform().indexToWorld(inside);
    GridPtr result = grid;
    const bool done = grid->transform().isLinear() && grid->apply<AttributeGrids>([&](auto& typed) {
        result = openvdb::tools::clip(typed, world);
        result->insertMeta(*grid);
        result->setName(grid->getName());
    });
    if (!done)
        message(ctx, MessageLevel::Warning,
                "grid \"" + grid->getName() + "\" (" + grid->valueType() + ") is kept whole, not cropped");
    return result;
}

Error nothingIn(const IndexBox& box, const LevelSet& model) {
    return Error(
        ErrorCode::EmptyInput,
        "`box` " + boxText(box) + ": no surface in it; the model's domain is " + boxText(model.domain));
}

LevelSet cropped(const LevelSet& model, const IndexBox& box, const RunContext& ctx) {
    const double voxel = voxelSizeOf(*model.grid);
    const float band = std::max(1.5f, std::min(kHalfWidth, float(halfWidthOf(*model.grid))));
    // Beyond the active voxels there is nothing to cut, however large the box.
    const IndexBox within = box.intersection(fromBBox(model.grid->evalActiveVoxelBoundingBox()).expanded(8));
    if (within.empty()) throw nothingIn(box, model);
    requireMemory(ctx, double(within.volume()) * 8.0 / 512, "a box of " + boxText(within),
                  "use a smaller `box`");
    const BrickField field = gatherBricks(*model.grid, within, float(1 / voxel), band, ctx);
    const BrickField closed = closeField(field, field.box(), kAllCut, band, ctx);
    FloatGridPtr grid = scatterBricks(closed, within.min, float(voxel), band, ctx);
    grid->setTransform(model.grid->transform().copy());
    if (grid->activeVoxelCount() == 0) throw nothingIn(box, model);
    LevelSet result;
    result.grid = grid;
    result.domain = box;
    result.domainRecorded = true;
    stampLevelSet(result);
    for (const GridPtr& attribute : model.attributes)
        result.attributes.push_back(clipped(attribute, *model.grid, box, ctx));
    return result;
}

}  // namespace

LevelSet cropModel(const LevelSet& model, const IndexBox& box, const RunContext& ctx) {
    return withThreads(ctx, [&] {
        requireModel(&model, "the model", ctx);
        requireBox(box, "box");
        return cropped(model, box, ctx);
    });
}

}  // namespace vdbsynth
