#include "libvdbsynth/pipeline/make/make_points.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/convert/field_model_steps.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"

#include <openvdb/openvdb.h>

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

// The points of a zero level inside a box of samples; those outside it are caps, or too near them.
PointCloud pointsWithin(const openvdb::FloatGrid& grid, double spacing, const Vec3d& low, const Vec3d& high,
                        const RunContext& ctx) {
    PointOptions options;
    options.spacing = spacing;
    const PointCloud all = levelSetToPoints(grid, options, ctx);
    PointCloud kept;
    kept.origin = all.origin;
    for (std::size_t i = 0; i < all.points.size(); ++i) {
        const Vec3d p = all.origin + cast<double>(all.points[i]);
        if (p.x < low.x || p.y < low.y || p.z < low.z || p.x > high.x || p.y > high.y || p.z > high.z)
            continue;
        kept.points.push_back(all.points[i]);
        kept.normals.push_back(all.normals[i]);
    }
    return kept;
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
    const LevelSet model = modelFromField(made.field, kExemplarLimit, made.exact, box, side / made.fine,
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
    result.cloud = pointsWithin(*model.grid, spacingOf(options) * made.fine, low, high, ctx);
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
