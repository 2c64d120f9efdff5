#include "libvdbsynth/pipeline/relief/relief.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/distance/close_band.h"
#include "libvdbsynth/geometry/point_neighbours.h"
#include "libvdbsynth/grid/components.h"
#include "libvdbsynth/grid/occupancy.h"
#include "libvdbsynth/pipeline/relief/relief_steps.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/band_grids.h"
#include "libvdbsynth/vdb/convert/kept_voxels.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kLimit = 3;  // [voxels] of the edited field

// How far the longest relief may reach. [voxels]
constexpr float kMostReach = 200;

double texelOf(const ReliefSource& source, double voxelSize, const ReliefOptions& options) {
    return (!source.scan && source.pixelSize > 0 ? source.pixelSize : voxelSize) * options.scale;
}

// Pictures keep their phase round the target.
void fit(std::vector<ReliefSample>& samples, const LevelSet& target, const ReliefOptions& options,
         ReliefResult& result, const RunContext& ctx) {
    if (!options.fit) return;
    const ReliefSample& sample = samples.front();
    if (samples.size() > 1 || sample.surface || !sample.image.tileable)
        throw Error(ErrorCode::Unusable, "`fit`: needs one tileable picture of heights");
    const PreparedTarget prepared = preparedTarget(target, 3, nullptr, options, ctx);
    const double period = sample.image.width * result.texel / prepared.place.voxelSize;
    result.fitted =
        fittingFactor(prepared.target, prepared.place, cast<double>(options.direction->axis), period);
    result.texel *= result.fitted;
    // Heights stay, in the new texels.
    for (float& h : samples.front().image.values) h /= float(result.fitted);
    samples.front().lowest /= float(result.fitted);
    samples.front().highest /= float(result.fitted);
    message(
        ctx, MessageLevel::Note,
        "the picture is resized by " + roundedText(result.fitted, 4) + ", so that whole periods go round");
}

// The sources of a band, by the nearest site's chart.
std::vector<GridPtr> sourceGrids(const LevelSet& model, const PreparedTarget& prepared,
                                 const std::vector<ReliefSample>& samples, const ReliefMap& map, float texel,
                                 const RunContext& ctx) {
    const bool scans = samples.front().surface != nullptr;
    std::vector<BandValue> values{{"source_u", 1}, {"source_v", 1}, {"exemplar", 1}};
    if (scans) values.push_back({"source", 3});
    const PointNeighbours nearest(prepared.target.point);
    const double toVoxel = 1 / prepared.place.voxelSize;
    const Vec3d origin = prepared.place.world({0, 0, 0});
    return bandGrids(
        *model.grid, values,
        [&](const Vec3d& world, float* out) {
            const Vec3d off = (world - origin) * toVoxel;
            const Vec3f turned = prepared.place.fromWorldDirection(off) * float(length(off));
            std::uint32_t site = 0;
            float squared = 0;
            nearest.nearest(turned, 1, &site, &squared);
            const Vec3f& n = prepared.target.normal[site];
            const Vec3f way = turned - prepared.target.point[site];
            const Vec2f at = map.coordinate[site] +
                             flattened(siteFrame(n, map.tangent[site]), way - n * dot(way, n)) * (1 / texel);
            const ReliefSample& sample = samples[std::size_t(map.sample[site])];
            out[0] = at.x;
            out[1] = at.y;
            out[2] = float(map.sample[site]);
            if (!scans) return;
            const Vec3f place = sample.surface ? reliefPlace(sample, at) : Vec3f{};
            for (int axis = 0; axis < 3; ++axis) out[3 + axis] = place[axis] + float(sample.corner[axis]);
        },
        ctx);
}

LevelSet finished(const BrickField& field, const PreparedTarget& prepared, const LevelSet& target,
                  const ReliefOptions& options, const RunContext& ctx) {
    CloseOptions close;
    close.cut = prepared.cut;
    close.halfWidth = options.halfWidth;
    close.band = kLimit;
    close.voxelSize = prepared.place.voxelSize;
    LevelSet made;
    made.grid = levelSetFrom(closedBand(field, prepared.corner, close, ctx), options.halfWidth, *target.grid,
                             "the target with relief", ctx);
    made.domain = target.domainRecorded ? target.domain : solidBox(*made.grid, "the target with relief");
    made.domainRecorded = target.domainRecorded;
    stampLevelSet(made);
    return made;
}

// Pieces that carving cuts off, and loose ones that a sample brings along.
void sayPieces(const BrickField& field, const PreparedTarget& prepared, const ReliefOptions& options,
               ReliefResult& result, const RunContext& ctx) {
    const auto parts = [&](const BrickField& of) {
        return findComponents(Occupancy::fromField(of, ctx), Neighbours::All).sizes.size();
    };
    const std::size_t before = parts(prepared.target.distance);
    result.parts = parts(field);
    if (result.parts == before) return;
    const std::string change = "the target's " + std::to_string(before) + (before == 1 ? " part" : " parts") +
                               " became " + std::to_string(result.parts);
    const bool keeps = options.method == ReliefMethod::Default && options.minWall == 0;
    message(ctx, MessageLevel::Warning,
            change + " with relief" +
                (keeps ? "; `minWall` keeps thin parts whole, a smaller `strength` helps too"
                       : "; a smaller `strength` changes less"));
}

bool masked(const ReliefTarget& target) {
    return std::any_of(target.strength.begin(), target.strength.end(), [](float s) { return s < 1; });
}

ReliefResult transferred(const std::vector<ReliefSource>& sources, const LevelSet& target,
                         const ReliefLabels& labels, const ReliefOptions& options, const RunContext& ctx) {
    ReliefResult result;
    const double voxelSize = voxelSizeOf(*target.grid);
    result.texel = texelOf(sources.front(), voxelSize, options);
    std::vector<ReliefSample> samples;
    for (const ReliefSource& source : sources)
        samples.push_back(preparedSample(source, result.texel, voxelSize, options, result, ctx));
    for (ReliefSample& sample : samples) {
        result.folds = result.folds || sample.folds;
        withChannels(sample,
                     std::any_of(samples.begin(), samples.end(), [](const auto& s) { return s.folds; }));
    }
    fit(samples, target, options, result, ctx);
    ReliefTransferOptions transfer;
    transfer.texel = result.texel / voxelSize;
    transfer.strength = options.strength;
    transfer.minWall = options.minWall / voxelSize;
    transfer.synthesis = options.synthesis;
    const float reach = reliefReach(samples, transfer);
    result.reach = double(reach) * voxelSize;
    if (reach > kMostReach)
        throw Error(ErrorCode::Unusable, "the relief would reach " + roundedText(double(reach), 3) +
                                             " voxels from the target, over " +
                                             roundedText(double(kMostReach), 3) +
                                             "; use a smaller `height`, `scale` or `strength`");
    const PreparedTarget prepared = preparedTarget(target, reach, labels, options, ctx);
    ReliefMap map;
    BrickField field;
    if (options.method == ReliefMethod::Paper) {
        field = grownOnTarget(samples.front(), prepared, options, result, ctx);
    } else {
        map = matchRelief(prepared.target, samples, transfer, ctx);
        if (options.fit)
            wrapAround(prepared, cast<double>(options.direction->axis), transfer.texel,
                       samples.front().image.width, map);
        field = reliefOnTarget(prepared.target, samples, map, transfer, ctx);
    }
    sayPieces(field, prepared, options, result, ctx);
    result.model = finished(field, prepared, target, options, ctx);
    if ((masked(prepared.target) || options.strength == 0) && options.method == ReliefMethod::Default &&
        std::abs(halfWidthOf(*target.grid) - double(options.halfWidth)) < 1e-6)
        result.unchanged = keepUnchanged(*target.grid, prepared.target.distance, field, prepared.corner,
                                         kLimit, options.halfWidth, *result.model.grid, ctx);
    if (options.method == ReliefMethod::Default)
        result.sources = sourceGrids(result.model, prepared, samples, map, float(transfer.texel), ctx);
    result.levels = std::move(map.levels);
    for (const Vec3f& s : map.singularities) result.singularities.push_back(prepared.place.world(s));
    return result;
}

}  // namespace

void validate(const ReliefOptions& options) {
    const auto number = [](double v) { return roundedText(v, 6); };
    requireOption(options.baseRadius >= 0 && options.baseRadius < 1e30, "baseRadius",
                  number(options.baseRadius), "above 0 (world), or 0 for the spectrum's gap");
    requireOption(options.scale >= 0.05 && options.scale <= 20, "scale", number(options.scale),
                  "from 0.05 to 20");
    requireOption(std::abs(options.strength) <= 100, "strength", number(options.strength),
                  "from -100 to 100");
    requireOption(options.minWall >= 0 && options.minWall < 1e30, "minWall", number(options.minWall),
                  "at least 0 (world)");
    requireOption(options.neighbourhood >= 0 && options.neighbourhood < 1e30, "neighbourhood",
                  number(options.neighbourhood), "above 0 (world), or 0 for the default");
    requireOption(options.top >= 0 && options.top <= 100, "top", number(options.top),
                  "from 0 to 100 (percent)");
    requireOption(options.fade >= 0 && options.fade < 1e30, "fade", number(options.fade),
                  "at least 0 (world)");
    requireHalfWidth(double(options.halfWidth));
    validate(options.synthesis);
    if (options.fade > 0 && !options.maskModel)
        throw Error(ErrorCode::InvalidOption, "`fade`: has no effect without a model as `mask`");
    if (options.fit && (!options.direction || options.direction->kind != DirectionSource::Kind::Around))
        throw Error(ErrorCode::InvalidOption, "`fit`: needs a `direction` around an axis, such as around:z");
}

ReliefResult transferRelief(const std::vector<ReliefSource>& samples, const LevelSet& target,
                            const ReliefLabels& labels, const ReliefOptions& options, const RunContext& ctx) {
    validate(options);
    if (samples.empty()) throw Error(ErrorCode::EmptyInput, "there is no sample");
    if (options.method == ReliefMethod::Paper && samples.size() > 1)
        throw Error(ErrorCode::InvalidOption, "`method`: the paper's takes one sample");
    return withThreads(ctx, [&] {
        for (const ReliefSource& source : samples)
            if (source.scan) requireModel(source.scan, "the sample", ctx);
        requireModel(&target, "the target", ctx);
        return transferred(samples, target, labels, options, ctx);
    });
}

}  // namespace vdbsynth
