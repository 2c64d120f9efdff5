#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/raster/height_field.h"
#include "libvdbsynth/raster/raster_alignment.h"
#include "libvdbsynth/raster/volume_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/pipeline/convert/model_steps.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/vdb/convert/attribute_grids.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <openvdb/tools/ChangeBackground.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

namespace vdbsynth {
namespace {

double longestSide(const std::string& path, const std::vector<Vec3f>& points) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Vec3f& p : points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], double(p[axis]));
            high[axis] = std::max(high[axis], double(p[axis]));
        }
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(side > 0)) throw Error(ErrorCode::Unusable, path + ": all its points coincide");
    return side;
}

// The requested voxel size, or that of the resolution along the longest side of some points.
double chooseVoxelSize(const std::string& path, const std::vector<Vec3f>& points, const ModelOptions& options,
                       const RunContext& ctx) {
    if (options.voxelSize > 0) return options.voxelSize;
    const int resolution = options.resolution > 0 ? options.resolution : kDefaultResolution;
    const double voxelSize = longestSide(path, points) / resolution;
    message(ctx, options.resolution > 0 ? MessageLevel::Detail : MessageLevel::Note,
            path + ": voxel size " + roundedText(voxelSize, 6) + " (" + std::to_string(resolution) +
                " voxels along the longest side" +
                (options.resolution > 0 ? ")" : "; `resolution` or `voxelSize` sets it)"));
    return voxelSize;
}

LevelSet asModel(const FloatGridPtr& grid, const std::string& path) {
    LevelSet model;
    model.grid = grid;
    model.domain = solidBox(*grid, path);
    stampLevelSet(model);
    return model;
}

// The points that faces use: a mesh file may hold others.
std::vector<Vec3f> usedPoints(const Mesh& mesh) {
    std::vector<char> used(mesh.points.size(), 0);
    for (const Triangle& t : mesh.triangles)
        for (std::uint32_t i : t) used[i] = 1;
    for (const Quad& q : mesh.quads)
        for (std::uint32_t i : q) used[i] = 1;
    std::vector<Vec3f> points;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) points.push_back(mesh.points[i]);
    return points;
}

void scalePoints(std::vector<Vec3f>& points, Vec3d& origin, double scale) {
    if (scale == 1) return;
    origin = origin * scale;
    for (Vec3f& p : points) p = cast<float>(cast<double>(p) * scale);
}

LevelSet loadMesh(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    Mesh mesh = readMesh(path, ctx);
    scalePoints(mesh.points, mesh.origin, options.unitScale);
    const double voxelSize = chooseVoxelSize(path, usedPoints(mesh), options, ctx);
    LevelSet model = asModel(meshToSolid(mesh, voxelSize, options.halfWidth, path, options.solid, ctx), path);
    if (options.keepSource) model.source = std::make_shared<const Mesh>(mesh);
    if (options.carry) model.attributes = attributesToGrids(mesh, *model.grid, ctx);
    return model;
}

LevelSet loadPoints(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    PointFile file = readPoints(path, ctx);
    if (file.invalid > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + countText(file.invalid, "point") + " without finite coordinates left out");
    scalePoints(file.cloud.points, file.cloud.origin, options.unitScale);
    // Outliers would make the voxels too large.
    PointCloud core = file.cloud;
    dropOutliers(core, ctx);
    const double voxelSize = chooseVoxelSize(path, core.points, options, ctx);
    LevelSet model =
        asModel(pointsToSolid(file.cloud, voxelSize, options.halfWidth, path, options.solid, ctx), path);
    if (options.carry) model.attributes = attributesToGrids(core, *model.grid, ctx);
    return model;
}

// A level set at the requested voxel size: its own if none is requested.
LevelSet atVoxelSize(const std::string& path, const LevelSet& model, const ModelOptions& options,
                     const RunContext& ctx) {
    const double present = voxelSizeOf(*model.grid);
    const Index3 size = model.domain.size();
    const double wanted = options.voxelSize > 0 ? options.voxelSize
                          : options.resolution > 0
                              ? present * std::max({size.x, size.y, size.z}) / options.resolution
                              : present;
    if (std::abs(wanted - present) <= 1e-6 * present) return model;
    message(ctx, MessageLevel::Note,
            path + ": resampled from voxels of " + roundedText(present, 6) + " to " + roundedText(wanted, 6));
    return resampled(model, wanted, ctx, path);
}

// Voxels of the field's directions and origin; a rotation stays in the transform, so nothing is resampled.
void placeInWorld(const RasterField& field, openvdb::FloatGrid& grid) {
    const Vec3d& o = field.origin;
    if (!runAlongWorld(field.axes)) {
        // OpenVDB multiplies from the left: the rows are the steps from voxel to voxel.
        openvdb::Mat4d matrix = openvdb::Mat4d::identity();
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) matrix(i, j) = field.axes[std::size_t(i)][j] * field.voxelSize;
        grid.setTransform(openvdb::math::Transform::createLinearTransform(matrix));
    }
    if (!(o.x == 0 && o.y == 0 && o.z == 0)) grid.transform().postTranslate({o.x, o.y, o.z});
}

// An image as a slab, a volume by its threshold or labels; both have a domain.
LevelSet loadRaster(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    Raster raster = readRaster(path, {options.grid}, ctx);
    if (options.unitScale != 1) {
        raster.spacing = raster.spacing * options.unitScale;
        raster.origin = raster.origin * options.unitScale;
        raster.unit.clear();
    }
    const bool image = !raster.stack && raster.size.z == 1 && !options.imageAsVolume;
    if (image && (options.volume.threshold || options.volume.below || !options.volume.labels.empty()))
        throw Error(ErrorCode::InvalidOption,
                    std::string(options.volume.threshold ? "`threshold`"
                                : options.volume.below   ? "`below`"
                                                         : "`labels`") +
                        ": " + path + " is an image; with `imageAsVolume` it is a volume of one slice");
    HeightOptions heights = options.heights;
    heights.voxelSize = options.voxelSize;
    heights.resolution = options.resolution;
    const RasterField field =
        image ? heightField(path, raster, heights, ctx) : volumeField(path, raster, options.volume, ctx);
    if (!field.description.empty()) message(ctx, MessageLevel::Note, path + ": " + field.description);
    sayLostHeights(path, raster, field, ctx);
    LevelSet model = modelFromField(field.field, kRasterFieldLimit, /* exact= */ false, field.distanceBand,
                                    field.domain, field.voxelSize, path, "no part of it is solid", ctx);
    sayLostSamples(path, field, *model.grid, ctx);
    placeInWorld(field, *model.grid);
    if (!image) model = atVoxelSize(path, model, options, ctx);
    setUnit(*model.grid, raster.unit);
    return model;
}

// A level set's values are lengths, so they change with the unit.
FloatGridPtr scaledBy(const openvdb::FloatGrid& grid, double scale) {
    const openvdb::FloatGrid::Ptr scaled = grid.deepCopy();
    for (auto it = scaled->beginValueAll(); it; ++it) it.setValue(float(double(*it) * scale));
    openvdb::tools::changeBackground(scaled->tree(), float(double(grid.background()) * scale));
    scaled->transform().postScale(scale);
    return scaled;
}

LevelSet loaded(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    const bool asRaster = options.imageAsVolume && isRasterPath(path);
    if (isPointPath(path) || (!asRaster && holdsPoints(path))) return loadPoints(path, options, ctx);
    if (isMeshPath(path)) return loadMesh(path, options, ctx);
    if (isRasterPath(path)) return loadRaster(path, options, ctx);
    VdbReadOptions read;
    read.gridName = options.grid;
    read.iso = options.iso;
    const std::vector<GridPtr> grids = readVdbGrids(path, ctx);
    LevelSet model = modelFromGrids(path, grids, read, ctx);
    if (options.unitScale != 1) model.grid = scaledBy(*model.grid, options.unitScale);
    model = atVoxelSize(path, model, options, ctx);
    const GridPtr used = pickedGrid(path, grids, read);
    // Steps above make new grids; in another unit the name is wrong.
    setUnit(*model.grid, options.unitScale == 1 ? unitOf(*used) : "");
    if (options.carry) {
        // All except the one that became the model; fog that a level set was made of stays among them.
        const bool fog =
            options.iso && used->getGridClass() != openvdb::GRID_LEVEL_SET && used->getName() != kSurfaceName;
        std::copy_if(grids.begin(), grids.end(), std::back_inserter(model.attributes),
                     [&](const GridPtr& grid) { return fog || grid != used; });
    }
    return model;
}

}  // namespace

void validate(const ModelOptions& options) {
    requireOption(options.voxelSize >= 0 && options.voxelSize < 1e30, "voxelSize",
                  roundedText(options.voxelSize, 6), "above 0 (world)");
    requireOption(options.resolution == 0 || (options.resolution >= 2 && options.resolution <= 100000),
                  "resolution", std::to_string(options.resolution), "a whole number from 2 to 100000");
    requireOption(options.unitScale > 0 && options.unitScale < 1e30, "unitScale",
                  roundedText(options.unitScale, 6), "above 0");
    requireHalfWidth(options.halfWidth);
    validate(options.solid);
    VdbReadOptions read;
    read.iso = options.iso;
    validate(read);
    validate(options.heights);
    validate(options.volume);
}

LevelSet loadModel(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    requireModelPath(path);
    validate(options);
    noteUnusedOptions(path, options, ctx);
    return withThreads(ctx, [&] { return loaded(path, options, ctx); });
}

LevelSet withHalfWidth(const LevelSet& model, double halfWidth, const RunContext& ctx) {
    requireHalfWidth(halfWidth);
    requireModel(&model, "the model", ctx);
    const double present = halfWidthOf(*model.grid);
    if (std::abs(present - halfWidth) < 1e-3 * halfWidth) return model;
    message(ctx, MessageLevel::Detail,
            "the band of " + std::to_string(present) + " voxels a side is re-distanced to " +
                std::to_string(halfWidth));
    LevelSet result = model;
    result.grid =
        withThreads(ctx, [&] { return rebuildLevelSet(*model.grid, float(halfWidth), "the model", ctx); });
    stampLevelSet(result);
    setUnit(*result.grid, unitOf(*model.grid));
    return result;
}

}  // namespace vdbsynth
