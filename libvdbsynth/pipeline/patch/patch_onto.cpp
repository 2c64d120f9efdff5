#include "libvdbsynth/pipeline/patch/patch_onto.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/convert/domain_faces.h"
#include "libvdbsynth/pipeline/convert/model.h"
#include "libvdbsynth/pipeline/texture/texture_steps.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr double kVoxel = 0.5;                          // [steps] of models that are no level sets
constexpr double kLeastVoxels = 0.25, kMostVoxels = 4;  // between sites, of level sets that are kept
constexpr float kCapCosine = 0.7f;                      // of a cap's normal to its face's
constexpr double kCapDepth = 0.75;                      // [voxels] from a face of the domain
constexpr double kHeldBend = 0.9;                       // height times curvature that is called good

// Points on the flat ends of a model that was cut at its domain.
void dropCaps(const LevelSet& model, PointCloud& cloud) {
    const CutFaces cut = facesTouched(model);
    if (std::none_of(cut.begin(), cut.end(), [](bool face) { return face; })) return;
    const openvdb::math::Transform& place = model.grid->transform();
    PointCloud kept;
    for (std::size_t p = 0; p < cloud.points.size(); ++p) {
        const Vec3d world = cast<double>(cloud.points[p]) + cloud.origin;
        const openvdb::Vec3d at = place.worldToIndex(openvdb::Vec3d(world.x, world.y, world.z));
        bool cap = false;
        for (int axis = 0; axis < 3; ++axis) {
            const float faces = cloud.normals[p][axis];
            cap = cap || (cut[std::size_t(2 * axis)] && faces < -kCapCosine &&
                          at[axis] < model.domain.min[axis] + kCapDepth - 0.5);
            cap = cap || (cut[std::size_t(2 * axis + 1)] && faces > kCapCosine &&
                          at[axis] > model.domain.max[axis] - kCapDepth + 0.5);
        }
        if (cap) continue;
        kept.points.push_back(cloud.points[p]);
        kept.normals.push_back(cloud.normals[p]);
    }
    cloud.points = std::move(kept.points);
    cloud.normals = std::move(kept.normals);
}

OntoSurface surfaceOf(const PointCloud& cloud, double spacing, const PatchOntoOptions& options,
                      const RunContext& ctx) {
    std::vector<Vec3f> directions;
    if (options.direction) {
        TextureShape shape;
        shape.origin = cloud.origin;
        shape.site = cloud.points;
        shape.normal = cloud.normals;
        directions = siteDirections(shape, *options.direction, ctx);
    }
    return ontoSurface(cloud.points, cloud.normals, directions, spacing, ctx);
}

std::string percent(double share) {
    return roundedText(100 * share, 3) + " %";
}

void describe(const OntoSurface& surface, const OntoResult& result, double scale, const RunContext& ctx) {
    const OntoBend& bend = result.bend;
    if (bend.folded > 0)
        message(ctx, MessageLevel::Note,
                "on " + percent(bend.folded) +
                    " of the model's surface the exemplar's height times the curvature is over one, so that "
                    "it folds; " +
                    std::to_string(bend.dropped) + " points are left out there. A `scale` of " +
                    roundedText(scale * std::min(1.0, kHeldBend / bend.most), 2) +
                    " holds on all but a hundredth of the surface");
    if (bend.bare > 0)
        message(ctx, MessageLevel::Note,
                percent(double(bend.bare) / double(surface.sites.size())) +
                    " of the model's surface are parts too narrow for a patch and carry nothing; a smaller "
                    "`scale` may reach them");
    if (!surface.singularities.empty())
        message(ctx, MessageLevel::Detail,
                "the direction has " + std::to_string(surface.singularities.size()) +
                    " places where it is not continuous; patches meet there at an angle");
}

Attribute wholeNumbers(const std::string& name) {
    Attribute attribute;
    attribute.name = name;
    return attribute;
}

}  // namespace

void validate(const PatchOntoOptions& options) {
    validate(options.onto);
    if (options.direction) requireDirection(*options.direction, "direction");
}

LevelSet loadOntoModel(const std::string& path, const PatchSource& source, const PatchOntoOptions& options,
                       const RunContext& ctx) {
    validate(options);
    const double spacing = siteSpacing(scaledExemplar(source.exemplar, options.onto.scale), options.onto);
    ModelOptions model;
    model.voxelSize = kVoxel * spacing;
    if (kindOf(path) != TargetKind::LevelSet) return loadModel(path, model, ctx);
    model.voxelSize = 0;
    LevelSet own = loadModel(path, model, ctx);
    const double voxels = spacing / voxelSizeOf(*own.grid);
    if (voxels >= kLeastVoxels && voxels <= 100) return own;
    model.voxelSize = kVoxel * spacing;
    return loadModel(path, model, ctx);
}

PatchedModel patchOnto(const PatchSource& source, const LevelSet& model, const PatchOntoOptions& options,
                       const RunContext& ctx) {
    validate(options);
    requireModel(&model, "the model", ctx);
    return withThreads(ctx, [&] {
        PatchedModel patched;
        patched.exemplar = scaledExemplar(source.exemplar, options.onto.scale);
        const double spacing = siteSpacing(patched.exemplar, options.onto);
        const double voxels = std::clamp(spacing / voxelSizeOf(*model.grid), kLeastVoxels, 100.0);
        PointCloud cloud = levelSetToPoints(*model.grid, {voxels}, ctx);
        dropCaps(model, cloud);
        patched.surface = surfaceOf(cloud, spacing, options, ctx);
        patched.origin = cloud.origin;
        patched.result = synthesizeOnto(patched.exemplar, patched.surface, options.onto, ctx);
        describe(patched.surface, patched.result, options.onto.scale, ctx);
        return patched;
    });
}

PointCloud ontoCloud(const PatchSource& source, const PatchedModel& patched) {
    const SheetPoints& points = patched.result.sheet;
    PointCloud cloud;
    cloud.points = points.points;
    cloud.normals = points.normals;
    cloud.origin = patched.origin;
    std::vector<std::size_t> rows;
    Attribute patch = wholeNumbers("patch"), number = wholeNumbers("source");
    for (std::size_t p = 0; p < points.size(); ++p) {
        rows.push_back(patched.exemplar.number[points.source[p]]);
        patch.values.push_back(float(points.patch[p]));
        number.values.push_back(float(rows.back()));
    }
    cloud.attributes = selectRows(source.attributes, rows);
    cloud.attributes.push_back(std::move(patch));
    cloud.attributes.push_back(std::move(number));
    return cloud;
}

}  // namespace vdbsynth
