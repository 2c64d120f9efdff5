#include "libvdbsynth/pipeline/relief/relief_extract.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/pipeline/relief/relief_extract_steps.h"
#include "libvdbsynth/relief/relief_strength.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kFar = 0.01;      // share of a scan too far from its base, from which a warning says so
constexpr double kNothing = 0.05;  // [voxels] deviation under which there is no relief
constexpr double kEdgeRadii = 2;   // beside a cut face, where a mean sees what is not known

struct Scan {
    BrickField field;
    Index3 corner;
    IndexBox domain;
};

Scan gatherScan(const LevelSet& model, double radius, const RunContext& ctx) {
    const IndexBox solid = model.domainRecorded ? model.domain : solidBox(*model.grid, "the model");
    const IndexBox box = model.domainRecorded ? solid : solid.expanded(baseMargin(radius));
    requireMemory(ctx, double(box.volume()) * 0.25 + 60.0 * double(activeVoxels(*model.grid)),
                  "a box of " + boxText(box), "use a smaller `baseRadius` or larger voxels");
    return {gatherNarrowBand(*model.grid, box, ctx), box.min, {solid.min - box.min, solid.max - box.min}};
}

double longestSide(const IndexBox& box) {
    const Index3 size = box.size();
    return std::max({size.x, size.y, size.z});
}

// In voxels.
double radiusOf(const LevelSet& model, const ReliefExtractOptions& options, ReliefExtraction& result,
                const RunContext& ctx) {
    const double voxel = voxelSizeOf(*model.grid);
    if (options.baseRadius > 0) {
        const double radius = options.baseRadius / voxel;
        requireOption(radius >= 1 && radius <= 1000, "baseRadius", roundedText(options.baseRadius, 6),
                      "from " + roundedText(voxel, 6) + " to " + roundedText(1000 * voxel, 6) +
                          " (world), 1 to 1000 voxels");
        return radius;
    }
    const IndexBox solid = model.domainRecorded ? model.domain : solidBox(*model.grid, "the model");
    const double longest = longestSide(solid);
    const Scan scan = gatherScan(model, largestBaseRadius(longest), ctx);
    result.scale = findBaseRadius(scan.field, longest, kHalfWidth, ctx);
    for (std::size_t i = 0; i < result.scale.radii.size(); ++i)
        message(ctx, MessageLevel::Detail,
                "a base of radius " + roundedText(result.scale.radii[i] * voxel, 4) + " takes off " +
                    roundedText(result.scale.deviation[i] * voxel, 4) + " (root mean square, world)");
    message(ctx, result.scale.gap ? MessageLevel::Detail : MessageLevel::Note,
            "base radius " + roundedText(result.scale.radius * voxel, 4) +
                " (world): " + result.scale.reason + (result.scale.gap ? "" : "; give `baseRadius`"));
    return result.scale.radius;
}

// A base with void around has good distances already.
BrickField clampedBand(const BrickField& field, const ReliefExtraction& result, float halfWidth,
                       const RunContext& ctx) {
    BrickField clamped = BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = std::clamp(samples[i], -halfWidth, halfWidth);
    });
    clamped.translate(result.corner);
    return clamped;
}

// A field over the domain as a level set.
LevelSet levelSetOf(const BrickField& field, float band, const ReliefExtraction& result, const LevelSet& like,
                    const char* name, double halfWidth, bool distances, const RunContext& ctx) {
    CloseOptions close;
    if (result.recorded) close.cut = kAllCut;
    close.halfWidth = float(halfWidth);
    close.band = band;
    close.voxelSize = result.voxelSize;
    const BrickField closed = distances && !result.recorded
                                  ? clampedBand(field, result, float(halfWidth), ctx)
                                  : closedBand(field, result.corner, close, ctx);
    LevelSet made;
    made.grid = levelSetFrom(closed, float(halfWidth), *like.grid, std::string("the ") + name, ctx);
    made.domain = result.recorded ? like.domain : solidBox(*made.grid, std::string("the ") + name);
    made.domainRecorded = result.recorded;
    stampLevelSet(made);
    made.grid->setName(name);
    return made;
}

// The domain without what lies beside faces that cut the base.
IndexBox measuredBox(const ReliefExtraction& result, double radius, const RunContext& ctx) {
    IndexBox box = result.domain;
    if (!result.recorded) return {};
    const Mesh mesh = zeroLevel(result.fields.distance, box, Facing::Outward, ctx);
    const Index3 size = box.size();
    for (int axis = 0; axis < 3; ++axis) {
        const int by = std::min(int(std::ceil(kEdgeRadii * radius)), size[axis] / 4);
        bool low = false, high = false;
        for (const Vec3f& p : mesh.points) {
            low = low || p[axis] < float(result.domain.min[axis]) + 1.5f;
            high = high || p[axis] > float(result.domain.max[axis]) - 1.5f;
        }
        if (low) box.min[axis] += by;
        if (high) box.max[axis] -= by;
    }
    return box;
}

void sayWhatIsLost(const ReliefExtraction& result, const RunContext& ctx) {
    const double voxel = result.voxelSize;
    if (result.fields.beyond > kFar)
        message(ctx, MessageLevel::Warning,
                roundedText(100 * result.fields.beyond, 2) + " % of the scan is over " +
                    roundedText(double(result.fields.reach) * voxel, 3) +
                    " from the base and no part of its relief; a smaller `baseRadius` than " +
                    roundedText(result.radius, 4) + " keeps thin parts in the base");
    if (result.statistics.sq < kNothing)
        message(ctx, MessageLevel::Warning,
                "the model has no relief at this scale (Sq " + roundedText(result.statistics.sq * voxel, 3) +
                    "); more voxels or a larger `baseRadius` may find one");
    if (result.statistics.folded > 0)
        message(ctx, MessageLevel::Note,
                "the relief folds on " + roundedText(100 * result.statistics.folded, 2) +
                    " % of the base; there relief_vector holds it");
}

ReliefExtraction extracted(const LevelSet& model, const ReliefExtractOptions& options,
                           const RunContext& ctx) {
    ReliefExtraction result;
    result.voxelSize = voxelSizeOf(*model.grid);
    result.recorded = model.domainRecorded;
    BaseOptions of;
    of.kind = options.base;
    of.radius = radiusOf(model, options, result, ctx);
    of.band = kHalfWidth;
    of.reach = std::max(3.f, float(options.halfWidth) + 1);
    result.radius = of.radius * result.voxelSize;
    Scan scan = gatherScan(model, of.radius, ctx);
    result.corner = scan.corner;
    result.domain = result.recorded ? scan.domain : scan.field.box();
    result.fields = baseSurface(scan.field, of, ctx);
    result.base = levelSetOf(result.fields.distance, result.fields.reach, result, model, "base",
                             options.halfWidth, true, ctx);
    // Half a voxel more: the level set has distances of its own, and the relief is active where that is.
    const ReliefLayer layer = reliefLayer(result.fields, float(options.halfWidth) + 0.5f, ctx);
    makeReliefGrids(result, layer);
    result.statistics = reliefStatistics(result.fields, measuredBox(result, of.radius, ctx), ctx, &layer);
    compareTopology(result, ctx);
    sayWhatIsLost(result, ctx);
    if (options.strength)
        result.surface = levelSetOf(reliefSurface(result.fields, *options.strength, ctx), 3, result, model,
                                    kSurfaceName, options.halfWidth, false, ctx);
    return result;
}

}  // namespace

void validate(const ReliefExtractOptions& options) {
    requireOption(options.baseRadius >= 0 && options.baseRadius < 1e30, "baseRadius",
                  roundedText(options.baseRadius, 6), "above 0 (world), or 0 for the spectrum's gap");
    if (options.strength)
        requireOption(std::abs(*options.strength) <= 100, "strength", roundedText(*options.strength, 6),
                      "from -100 to 100");
    requireHalfWidth(options.halfWidth);
}

ReliefExtraction extractRelief(const LevelSet& model, const ReliefExtractOptions& options,
                               const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&] {
        requireModel(&model, "the model", ctx);
        return extracted(model, options, ctx);
    });
}

}  // namespace vdbsynth
