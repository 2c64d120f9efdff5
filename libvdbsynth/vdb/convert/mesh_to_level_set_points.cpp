// Solids from oriented points.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/point_field.h"
#include "libvdbsynth/vdb/convert/far_grid.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set_steps.h"
#include "libvdbsynth/vdb/convert/surface_kept.h"

#include <cmath>
#include <string>
#include <vector>

namespace vdbsynth {
namespace {

void sayOutliers(const Outliers& outliers, std::size_t points, const std::string& name,
                 const RunContext& ctx) {
    if (outliers.points == 0) return;
    std::string text = name + ": " + countText(outliers.points, "outlier") + " of " +
                       countText(points, "point") + " left out";
    if (outliers.groups > 0)
        text += ", " + std::to_string(outliers.grouped) + " of them in " +
                countText(outliers.groups, "small group") + " away from the rest";
    message(ctx, MessageLevel::Warning, text);
}

}  // namespace

FloatGridPtr pointsToSolid(const PointCloud& cloud, double voxelSize, double halfWidth,
                           const std::string& name, const SolidOptions& options, const RunContext& ctx) {
    requireOption(std::isfinite(voxelSize) && voxelSize > 0, "voxelSize", std::to_string(voxelSize),
                  "above 0");
    requireOption(halfWidth >= 1.5 && halfWidth <= 1000, "halfWidth", std::to_string(halfWidth),
                  "from 1.5 to 1000 voxels");
    validate(options);
    requireVoxelSize(voxelSize, name);
    const bool shell = options.open == OpenMesh::Shell;
    requireOption(!shell || (std::isfinite(options.thickness) && options.thickness >= voxelSize), "thickness",
                  std::to_string(options.thickness),
                  "at least a voxel, which is " + std::to_string(voxelSize));
    const WholeVoxels place = wholeVoxels(cloud.origin, voxelSize);
    PointCloud index = cloud;
    sayOutliers(dropOutliers(index, ctx), cloud.points.size(), name, ctx);
    if (index.points.size() < 8)
        throw Error(ErrorCode::Unusable, name + ": " + countText(index.points.size(), "distinct point") +
                                             " cannot make a surface; 8 are needed");
    if (index.normals.empty()) {
        message(ctx, MessageLevel::Note, name + ": no normals; estimated and oriented consistently");
        estimateNormals(index, ctx);
    }
    for (Vec3f& p : index.points) p = cast<float>((cast<double>(p) + place.rest) * (1 / voxelSize));
    double area = 0;
    const std::vector<float> spacings = pointSpacing(index, ctx);
    for (float spacing : spacings) area += double(spacing) * double(spacing);
    requireMemory(ctx, area * 2 * halfWidth * 60,
                  name + ": a level set at voxel size " + std::to_string(voxelSize),
                  "use a larger `voxelSize` or a smaller `resolution`");
    Stage stage(ctx, "points to level set", 1);
    PointFieldOptions fieldOptions;
    if (shell) fieldOptions.thickness = float(options.thickness / voxelSize);
    fieldOptions.limit = kHalfWidth;
    const PointSolid solid = pointField(index, fieldOptions, ctx);
    if (solid.solidShare < 0.5)
        message(ctx, MessageLevel::Warning,
                name + ": " + std::to_string(int(100 * (1 - solid.solidShare))) +
                    " % of the points enclose nothing, as in a scan from one side; make a shell with `open` "
                    "shell and a `thickness`");
    stage.advance();
    const FloatGridPtr grid = levelSetOf(solid.field, voxelSize, float(halfWidth), name, ctx);
    if (!shell) requirePointsKept(index.points, spacings, solid.field, name, ctx);
    return movedBy(grid, place, name, ctx);
}

}  // namespace vdbsynth
