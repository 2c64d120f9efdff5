#include "libvdbsynth/vdb/convert/surface_kept.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/solid/surface_loss.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/level_set.h"

#include <algorithm>
#include <limits>

namespace vdbsynth {
namespace {

constexpr const char* kLostKey = "vdbsynth:lost_share";
constexpr double kWarned = 0.02;  // of the surface; less is what sharp edges and tips lose
constexpr double kSaid = 0.001;

std::string boundsText(const Vec3d& low, const Vec3d& high) {
    const auto text = [](const Vec3d& p) {
        return roundedText(p.x, 4) + "," + roundedText(p.y, 4) + "," + roundedText(p.z, 4);
    };
    return text(low) + " .. " + text(high);
}

// A note if the solid ends over a voxel before the mesh does.
void noteBounds(const MeshSummary& summary, const openvdb::FloatGrid& grid, const std::string& name,
                const RunContext& ctx) {
    const IndexBox box = solidBox(grid, name);
    bool shrunk = false;
    for (int axis = 0; axis < 3; ++axis)
        shrunk = shrunk || box.min[axis] - summary.boxMin[axis] > 1.5 ||
                 summary.boxMax[axis] - box.max[axis] > 1.5;
    if (!shrunk) return;
    const double voxel = voxelSizeOf(grid);
    Vec3d low = summary.boxMin, high = summary.boxMax;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::max(low[axis], box.min[axis] - 0.5);
        high[axis] = std::min(high[axis], box.max[axis] + 0.5);
    }
    message(ctx, MessageLevel::Note,
            name + ": its bounds shrink from " + boundsText(summary.boxMin * voxel, summary.boxMax * voxel) +
                ", to " + boundsText(low * voxel, high * voxel));
}

// What a thin solid broke into, if that is more than the mesh has; else empty.
std::string brokenText(BrickField& field, const SurfaceLoss& loss, const RunContext& ctx) {
    constexpr double kMostVoxels = 2e9;  // a bit each
    if (loss.parts == 0 || double(field.box().volume()) > kMostVoxels) return "";
    const Index3 corner = field.box().min;
    field.translate(Index3{0, 0, 0} - corner);
    const std::size_t parts = findComponents(Occupancy::fromField(field, ctx), Neighbours::All).sizes.size();
    field.translate(corner);
    return parts > loss.parts ? "; what is left breaks into " + std::to_string(parts) + " parts" : "";
}

}  // namespace

void requireKept(const Mesh& mesh, openvdb::FloatGrid& grid, const std::string& name, const RunContext& ctx) {
    const openvdb::CoordBBox active = grid.evalActiveVoxelBoundingBox();
    BrickField field(IndexBox::fromSize({1, 1, 1}), kHalfWidth);
    if (!active.empty()) {
        field = gatherBricks(grid, fromBBox(active), 1.f, std::numeric_limits<float>::infinity(), ctx);
        field.translate(fromCoord(active.min()));
    }
    const SurfaceLoss loss = surfaceLoss(mesh, field, ctx);
    const std::size_t whole = loss.lostSolids + loss.lostCavities + loss.lostOpen;
    if (loss.share < kSaid && whole == 0 && loss.volumeLeft >= 0.9) return;
    const MeshSummary summary = summarize(mesh);
    double side = 0;
    for (int axis = 0; axis < 3; ++axis) side = std::max(side, summary.boxMax[axis] - summary.boxMin[axis]);
    const double voxel = voxelSizeOf(grid);
    const std::string text = name + ": " + lossText(loss, voxel, side * voxel) + brokenText(field, loss, ctx);
    if (loss.share > 0.5 || loss.volumeLeft < 0.5) throw Error(ErrorCode::Unusable, text);
    grid.insertMeta(kLostKey, openvdb::FloatMetadata(float(loss.share)));
    const bool much = loss.share >= kWarned || whole > 0 || loss.volumeLeft < 0.9;
    message(ctx, much ? MessageLevel::Warning : MessageLevel::Note, text);
    noteBounds(summary, grid, name, ctx);
}

double lostShare(const openvdb::FloatGrid& grid) {
    const auto share = grid.getMetadata<openvdb::FloatMetadata>(kLostKey);
    return share ? double(share->value()) : 0;
}

void requirePointsKept(const std::vector<Vec3f>& points, const std::vector<float>& spacings,
                       const BrickField& field, const std::string& name, const RunContext& ctx) {
    constexpr double kNoise = 0.01;  // scans have some
    const double lost = pointLoss(points, spacings, field, ctx);
    if (lost < kNoise) return;
    const std::string text = name + ": " + std::to_string(int(100 * lost + 0.5)) +
                             " % of its points lie farther than a voxel and their spacing from the surface; "
                             "`open` shell with a `thickness` keeps them all";
    if (lost > 0.5) throw Error(ErrorCode::Unusable, text);
    message(ctx, MessageLevel::Warning, text);
}

}  // namespace vdbsynth
