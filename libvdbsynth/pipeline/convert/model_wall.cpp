#include "libvdbsynth/pipeline/convert/model_wall.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <cstdint>

namespace vdbsynth {

namespace {

// A table of bricks over the box needs eight bytes for 512 of them, used or not.
constexpr std::int64_t kMostVoxels = std::int64_t(1) << 34;

}  // namespace

std::optional<MinimalWall> modelWall(const LevelSet& model, const MinimalWallOptions& options,
                                     const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&] {
        requireModel(&model, "the model", ctx);
        constexpr int kMargin = 3;  // [voxels] of void
        const IndexBox box = solidBox(*model.grid, "the model").expanded(kMargin);
        if (box.volume() > kMostVoxels) {
            message(ctx, MessageLevel::Note,
                    "the minimal wall is not measured: the model's box has over 2^34 voxels; give fewer "
                    "voxels (`resolution`), or a part of the model");
            return std::optional<MinimalWall>();
        }
        std::optional<MinimalWall> wall = minimalWall(gatherNarrowBand(*model.grid, box, ctx), options, ctx);
        if (!wall) return wall;
        const Vec3d low{double(box.min.x), double(box.min.y), double(box.min.z)};
        wall->thickness *= voxelSizeOf(*model.grid);
        wall->place = fromVec(model.grid->indexToWorld(toVec(wall->place + low)));
        return wall;
    });
}

}  // namespace vdbsynth
