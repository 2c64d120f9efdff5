// Measurements made once for each model of a comparison.
#include "libvdbsynth/pipeline/compare/compare_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr int kMargin = 4;               // [voxels] around a whole object: its band and one more
constexpr double kThicknessLimit = 1e7;  // [voxels] of the largest model; above, all are halved for thickness
constexpr std::size_t kProjected = 4000;

Mesh surfaceOf(const openvdb::FloatGrid& grid, const Index3& corner, const RunContext& ctx) {
    Mesh mesh = zeroLevelInIndexSpace(grid, 0, ctx);
    for (Vec3f& p : mesh.points) p = p - Vec3f{float(corner.x), float(corner.y), float(corner.z)};
    return mesh;
}

// Peak memory of measuring: bits of solid and void, bricks, samples of thickness (distances, drawn balls, the
// two phases' results), and the surface with its elements and their sides.
double memoryFor(const IndexBox& box, int coarsening, std::uint64_t active) {
    const double samples = double(box.volume()) / coarsening / coarsening / coarsening;
    return double(box.volume()) * (0.25 + 8.0 / 512) + samples * 17 + double(active) * 50;
}

}  // namespace

PreparedModel prepareModel(const std::string& name, const LevelSet& levelSet, int coarsening,
                           const RunContext& ctx) {
    Stage reading(ctx, name + ": meshing", 1);
    const bool whole = !levelSet.domainRecorded;
    const IndexBox box = levelSet.domain.expanded(whole ? kMargin : 0);
    requireMemory(ctx, memoryFor(box, coarsening, activeVoxels(*levelSet.grid)), name + ": measuring it",
                  "compare smaller parts of it (crop) or larger voxels");
    PreparedModel result;
    result.corner = box.min;
    MeasuredModel& model = result.model;
    model.band = std::min(kHalfWidth, float(halfWidthOf(*levelSet.grid))) * 0.999f;
    model.field = std::make_shared<const BrickField>(
        gatherBricks(*levelSet.grid, box, float(1 / voxelSizeOf(*levelSet.grid)), kHalfWidth, ctx));
    model.counted = {levelSet.domain.min - box.min, levelSet.domain.max - box.min};
    model.beyond = whole ? Beyond::Void : Beyond::Unknown;
    model.surface = surfaceOf(*levelSet.grid, box.min, ctx);
    reading.advance();
    Stage thickness(ctx, name + ": thickness", 1);
    prepare(model, coarsening, ctx);
    thickness.advance();
    Stage drawing(ctx, name + ": patches", 1);
    PatchSourceOptions patches;
    patches.box = whole ? IndexBox::fromSize(box.size()) : model.counted.expanded(-kCapMargin);
    result.patches = patchSource(model.field, patches, ctx);
    for (const PatchScale& scale : result.patches.scales)
        result.projections.push_back(project(scale, kProjected, ctx));
    drawing.advance();
    return result;
}

std::array<bool, 3> cutAxes(const MeasuredModel& model) {
    std::array<bool, 3> axes{};
    if (model.beyond == Beyond::Void) return axes;
    for (int axis = 0; axis < 3; ++axis) {
        IndexBox low = model.counted, high = model.counted;
        low.max[axis] = low.min[axis];
        high.min[axis] = high.max[axis];
        const double below = double(model.solid.window(low).count()),
                     above = double(model.solid.window(high).count());
        axes[std::size_t(axis)] =
            below > 0 && above > 0 && std::min(below, above) > std::max(below, above) / 2;
    }
    return axes;
}

int thicknessCoarsening(const CompareInput& reference, const std::vector<CompareInput>& others) {
    double largest = double(reference.model.domain.volume());
    for (const CompareInput& other : others) largest = std::max(largest, double(other.model.domain.volume()));
    int coarsening = 1;
    while (largest / coarsening / coarsening / coarsening > kThicknessLimit) coarsening *= 2;
    return coarsening;
}

}  // namespace vdbsynth
