#include "libvdbsynth/pipeline/patch/patch_source.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/point_file.h"
#include "libvdbsynth/io/texture_box.h"
#include "libvdbsynth/patch/patch_size.h"
#include "libvdbsynth/patch/patch_synthesis.h"
#include "libvdbsynth/points/point_set_surface.h"
#include "libvdbsynth/vdb/convert/attribute_grids.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr std::size_t kFewest = 32;
constexpr double kKernels = 7;  // [spacings] that fields near the box's sides read beyond it
constexpr double kModelSpacing =
    0.5;                            // [voxels] of points on a level set: thin parts need several around them
constexpr double kCapCosine = 0.7;  // of a cap's normal to its side's

// What a file gives before the texture's box is known.
struct Content {
    std::vector<Vec3f> points, normals;
    Vec3d origin;  // that the points are relative to
    Attributes attributes;
    std::optional<PatchBox> box;      // that the file records
    std::optional<PatchPlane> plane;  // that the file records
    PatchBox bounds;
    double voxelSize = 0;
};

PatchPlane planeOf(HeightPlane plane) {
    return plane == HeightPlane::XY   ? PatchPlane::XY
           : plane == HeightPlane::YZ ? PatchPlane::YZ
                                      : PatchPlane::ZX;
}

const char* nameOf(PatchPlane plane) {
    return plane == PatchPlane::XY ? "xy" : plane == PatchPlane::YZ ? "yz" : "zx";
}

PatchBox boundsOf(const std::vector<Vec3f>& points) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    PatchBox box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    for (const Vec3f& point : points)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], double(point[axis]));
            box.max[axis] = std::max(box.max[axis], double(point[axis]));
        }
    return box;
}

Content fromPoints(const std::string& path, const RunContext& ctx) {
    PointFile file = readPoints(path, ctx);
    if (file.invalid > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(file.invalid) + " points without a finite place are left out");
    if (file.cloud.normals.empty()) {
        message(ctx, MessageLevel::Note,
                path +
                    ": has no normals; they are estimated, facing up at the top. Normals of the scanner's "
                    "say more");
        estimateNormals(file.cloud, ctx);
    }
    Content content;
    if (const auto box = textureBoxOf(path, file.comments)) {
        content.box = PatchBox{box->low - file.cloud.origin, box->high - file.cloud.origin};
        if (box->plane) content.plane = planeOf(*box->plane);
    }
    content.points = std::move(file.cloud.points);
    content.normals = std::move(file.cloud.normals);
    content.attributes = std::move(file.cloud.attributes);
    content.origin = file.cloud.origin;
    content.bounds = boundsOf(content.points);
    return content;
}

// True for a point on the flat end of a model that was cut at a side of its box.
bool isCap(const Vec3f& point, const Vec3f& normal, const PatchBox& box, double voxel, PatchPlane plane) {
    const int first = plane == PatchPlane::XY ? 0 : plane == PatchPlane::YZ ? 1 : 2;
    for (const int axis : {first, (first + 1) % 3}) {
        const double at = double(point[axis]), faces = double(normal[axis]);
        if (at < box.min[axis] + voxel && faces < -kCapCosine) return true;
        if (at > box.max[axis] - voxel && faces > kCapCosine) return true;
    }
    return false;
}

Content fromModel(const std::string& path, const PatchSourceOptions& options, const RunContext& ctx) {
    ModelOptions carrying = options.model;
    carrying.carry = true;
    const LevelSet model = loadModel(path, carrying, ctx);
    PointCloud cloud = levelSetToPoints(*model.grid, {kModelSpacing}, ctx);
    Content content;
    content.attributes = gridsToAttributes(model.attributes, cloud.points, cloud.origin, ctx);
    content.points = std::move(cloud.points);
    content.normals = std::move(cloud.normals);
    content.origin = cloud.origin;
    content.voxelSize = model.grid->voxelSize()[0];
    content.bounds = boundsOf(content.points);
    return content;
}

PatchPlane choosePlane(const Content& content, const PatchSourceOptions& options, const std::string& path,
                       const RunContext& ctx) {
    if (options.plane) return *options.plane;
    if (content.plane) return *content.plane;
    const Vec3d size = content.bounds.max - content.bounds.min;
    const PatchPlane plane = size.z <= size.x && size.z <= size.y ? PatchPlane::XY
                             : size.x <= size.y                   ? PatchPlane::YZ
                                                                  : PatchPlane::ZX;
    message(ctx, MessageLevel::Note,
            path + ": is thinnest across " + nameOf(plane) +
                ", so it is taken for a sheet along that plane; `plane` says another");
    return plane;
}

PatchBox lessMargin(PatchBox box, PatchPlane plane, double margin) {
    const int first = plane == PatchPlane::XY ? 0 : plane == PatchPlane::YZ ? 1 : 2;
    for (const int axis : {first, (first + 1) % 3}) {
        box.min[axis] += margin;
        box.max[axis] -= margin;
    }
    return box;
}

// A third of the patch that the whole of it would be cut into.
double marginOf(const Content& content, PatchPlane plane, double spacing, const RunContext& ctx) {
    const double least = kKernels * spacing;
    const PatchExemplar whole = patchExemplar(content.points, content.normals,
                                              lessMargin(content.bounds, plane, least), plane, spacing);
    const PointSetSurface surface(whole.points, whole.normals, {}, ctx);
    const double step = fieldStep(whole, {});
    const PatchField field =
        patchField(surface, whole.points, latticeOf(whole.size, step), {}, kFieldReach, ctx);
    return std::max(least, patchSide(field, patchFeature(field, ctx)) * field.lattice.step / 3);
}

void dropCaps(PatchPlane plane, Content& content, const std::string& path, const RunContext& ctx) {
    std::vector<Vec3f> points, normals;
    std::vector<std::size_t> rows;
    for (std::size_t p = 0; p < content.points.size(); ++p) {
        if (isCap(content.points[p], content.normals[p], content.bounds, content.voxelSize, plane)) continue;
        points.push_back(content.points[p]);
        normals.push_back(content.normals[p]);
        rows.push_back(p);
    }
    content.attributes = selectRows(content.attributes, rows);
    if (points.size() < content.points.size())
        message(ctx, MessageLevel::Detail,
                path + ": " + std::to_string(content.points.size() - points.size()) +
                    " points on its sides are caps, left out");
    content.points = std::move(points);
    content.normals = std::move(normals);
}

void requireRoom(const PatchBox& box, const std::string& path, double margin) {
    for (int axis = 0; axis < 3; ++axis)
        if (box.max[axis] < box.min[axis])
            throw Error(ErrorCode::Unusable,
                        path + ": a `margin` of " + roundedText(margin, 4) +
                            " on every side leaves nothing of it; a smaller `margin`, or a larger exemplar");
}

}  // namespace

void validate(const PatchSourceOptions& options) {
    validate(options.model);
    if (options.margin && !(*options.margin >= 0 && *options.margin < 1e30))
        throw Error(ErrorCode::InvalidOption, "`margin` must be at least 0");
}

PatchSource loadPatchSource(const std::string& path, const PatchSourceOptions& options,
                            const RunContext& ctx) {
    validate(options);
    const bool points = isPointPath(path) || holdsPoints(path);
    Content content = points ? fromPoints(path, ctx) : fromModel(path, options, ctx);
    if (content.points.size() < kFewest)
        throw Error(ErrorCode::EmptyInput, path + ": has " + std::to_string(content.points.size()) +
                                               " points, too few for a texture; at least " +
                                               std::to_string(kFewest));
    const PatchPlane plane = choosePlane(content, options, path, ctx);
    if (!points) dropCaps(plane, content, path, ctx);
    const PointSetSurface surface(content.points, content.normals, {}, ctx);
    const double spacing = surface.spacing();
    if (!(spacing > 0)) throw Error(ErrorCode::Unusable, path + ": all its points coincide");
    PatchSource source;
    source.recorded = content.box.has_value();
    PatchBox box = content.bounds;
    if (options.box) {
        box = {options.box->min - content.origin, options.box->max - content.origin};
    } else if (options.whole) {
        // As it is: the bounds of the points.
    } else if (content.box) {
        box = *content.box;
    } else {
        const double margin = options.margin ? *options.margin
                              : points       ? marginOf(content, plane, spacing, ctx)
                                             : kKernels * spacing;
        box = lessMargin(box, plane, margin);
        requireRoom(box, path, margin);
        message(ctx, MessageLevel::Note,
                path + ": does not say its box; its bounds less a margin of " + roundedText(margin, 4) +
                    " (world) are taken, `margin` says another");
    }
    source.exemplar = patchExemplar(content.points, content.normals, box, plane, spacing, !options.box);
    source.exemplar.kernel = fittingKernel(source.exemplar.points, source.exemplar.normals, spacing, ctx);
    source.exemplar.corner = source.exemplar.corner + content.origin;
    source.attributes = std::move(content.attributes);
    source.isPoints = points;
    if (options.whole)
        source.cloud = {std::move(content.points), std::move(content.normals), {}, content.origin};
    source.voxelSize = content.voxelSize > 0 ? content.voxelSize : spacing;
    return source;
}

}  // namespace vdbsynth
