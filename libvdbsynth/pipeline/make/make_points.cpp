#include "libvdbsynth/pipeline/make/make_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kLeastSpacing = 0.25, kMostSpacing = 1;  // [voxels] of the default
constexpr int kCapMargin = 2;                             // [samples] from the last point to the caps

double featureOf(const ExemplarOptions& exemplar) {
    return exemplar.feature > 0 ? exemplar.feature : exemplarKind(exemplar.kind).feature;
}

double spacingOf(const MakePointsOptions& options) {
    if (options.spacing > 0) return options.spacing;
    const ExemplarOptions& exemplar = options.model.exemplar;
    return std::clamp(exemplarKind(exemplar.kind).detail * featureOf(exemplar) / 4, kLeastSpacing,
                      kMostSpacing);
}

double marginOf(const MakePointsOptions& options) {
    return options.margin >= 0 ? options.margin : featureOf(options.model.exemplar) * 2 / 3;
}

// The domain and the margin, and room for what is computed at an edge. Nothing of a sheet's geometry is far
// above or below its domain.
ExemplarSampling samplingOf(const MakePointsOptions& options) {
    ExemplarSampling sampling;
    const int margin = int(std::ceil(marginOf(options))) + kExemplarMargin;
    sampling.margin = {margin, margin, margin};
    if (exemplarKind(options.model.exemplar.kind).isSheet()) sampling.margin.z = 2 * kExemplarMargin;
    sampling.fine = std::clamp(int(std::lround(1 / spacingOf(options))), 1, 8);
    return sampling;
}

// Drops the points outside a box: those on caps, or too near them.
void keepWithin(const Vec3d& low, const Vec3d& high, PointCloud& cloud) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        const Vec3d p = cloud.origin + cast<double>(cloud.points[i]);
        if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z)
            continue;
        cloud.points[kept] = cloud.points[i];
        cloud.normals[kept] = cloud.normals[i];
        ++kept;
    }
    cloud.points.resize(kept);
    cloud.normals.resize(kept);
}

Vec3d gradientAt(const std::function<double(const Vec3d&)>& surface, const Vec3d& p) {
    constexpr double kStep = 1e-4;  // [voxels]
    Vec3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3d ahead = p, behind = p;
        ahead[axis] += kStep;
        behind[axis] -= kStep;
        gradient[axis] = (surface(ahead) - surface(behind)) / (2 * kStep);
    }
    return gradient;
}

// Moves points from the sampled zero level onto the surface itself, and gives them its normals: those of
// samples differ by some degrees from voxel to voxel, which on thin tubes is as much as patches differ.
void settle(const ExemplarField& made, double side, PointCloud& cloud, const RunContext& ctx) {
    if (!made.surface) return;
    constexpr int kSteps = 3;
    constexpr double kFarthest = 0.5;  // [voxels]
    parallelFor(ctx, cloud.points.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d start = (cloud.origin + cast<double>(cloud.points[i])) * (1 / side);
            Vec3d p = start, gradient;
            for (int step = 0; step < kSteps; ++step) {
                gradient = gradientAt(made.surface, p);
                p = p - gradient * (made.surface(p) / std::max(dot(gradient, gradient), 1e-6));
            }
            gradient = gradientAt(made.surface, p);
            if (!(length(p - start) < kFarthest) || !(length(gradient) > 0.1)) continue;
            cloud.points[i] = cast<float>(p * side - cloud.origin);
            cloud.normals[i] = cast<float>(normalized(gradient));
        }
    });
}

void sayPacked(const std::string& kind, const RunContext& ctx) {
    if (kind == "balls" || kind == "foam")
        message(ctx, MessageLevel::Note,
                "make " + kind + ": packed anew in the domain and its margin; a level set or mesh of the " +
                    "same seed is another packing");
}

TexturePoints pointsOf(const MakePointsOptions& options, const RunContext& ctx) {
    const std::string& kind = options.model.exemplar.kind;
    sayPacked(kind, ctx);
    const ExemplarField made = makeExemplar(options.model.exemplar, samplingOf(options), ctx);
    const double side = options.model.voxelSize, margin = marginOf(options);
    const IndexBox box = made.field.box().expanded(-kCapMargin);
    const LevelSet model = modelFromField(made.field, kExemplarLimit, made.exact, 0, box, side / made.fine,
                                          "make " + kind, "use a larger `size` or another `seed`", ctx);
    TexturePoints result;
    Vec3d low, high;
    for (int axis = 0; axis < 3; ++axis) {
        result.box.low[axis] = (made.domain.min[axis] - 0.5) * side;
        result.box.high[axis] = (made.domain.max[axis] + 0.5) * side;
        low[axis] = result.box.low[axis] - margin * side;
        high[axis] = result.box.high[axis] + margin * side;
    }
    if (exemplarKind(kind).isSheet()) {
        result.box.plane = HeightPlane::XY;
        low.z = (made.domain.min.z - kExemplarMargin) * side;
        high.z = (made.domain.max.z + kExemplarMargin) * side;
    }
    PointOptions darts;
    darts.spacing = spacingOf(options) * made.fine;
    result.cloud = levelSetToPoints(*model.grid, darts, ctx);
    settle(made, side, result.cloud, ctx);
    keepWithin(low, high, result.cloud);
    if (result.cloud.points.empty())
        throw Error(ErrorCode::EmptyInput,
                    "make " + kind + ": the domain is empty; use a larger `size` or another `seed`");
    return result;
}

}  // namespace

void validate(const MakePointsOptions& options) {
    validate(options.model);
    requireOption(options.spacing == 0 || (options.spacing >= 0.125 && options.spacing <= 100), "spacing",
                  roundedText(options.spacing, 6), "from 0.125 to 100 voxels");
    requireOption(options.margin < 0 || options.margin <= 4000, "margin", roundedText(options.margin, 6),
                  "from 0 to 4000 voxels");
}

TexturePoints makePoints(const MakePointsOptions& options, const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&] { return pointsOf(options, ctx); });
}

}  // namespace vdbsynth
