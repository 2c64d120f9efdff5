// The samples of a relief.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/coordinates/sample_features.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/pipeline/relief/relief_steps.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kNothing = 0.05;  // [voxels] root mean square of heights under which there is no relief
constexpr double kMostlyRough = 0.9;
constexpr double kSeenVoxels = 0.45;  // sigma of what a voxel sees
constexpr double kFewCovered = 0.85;  // share of a scan under which a warning says what is not shown

double deviationOf(const ReliefSample& sample) {
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < sample.image.texels(); ++i) {
        if (!sample.image.valid.empty() && !sample.image.valid[i]) continue;
        const double h = double(sample.image.values[i * std::size_t(sample.image.channels)]);
        sum += h;
        squares += h * h;
        count += 1;
    }
    return count > 0 ? std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)) : 0;
}

ReliefSample sampleOfPicture(const ReliefSource& source, double texel, double voxelSize,
                             const ReliefOptions& options, const RunContext& ctx) {
    const double high = source.height > 0 ? source.height : kPictureHeight * voxelSize * options.scale;
    if (!(source.height > 0))
        message(
            ctx, MessageLevel::Note,
            "white is " + roundedText(high, 4) + " higher than black (world); `height` gives another height");
    SampleImage heights = source.heights;
    double mean = 0;
    for (float v : heights.values) mean += double(v);
    mean /= double(heights.values.size());
    for (float& v : heights.values) v = float((double(v) - mean) * high / texel);
    // Pixels finer than voxels are seen by these as means.
    const double sigma = texel < voxelSize ? kSeenVoxels * voxelSize / texel : 0;
    return reliefSample(smoothed(heights, sigma, ctx));
}

// What is wrong with a direction is said of the target's; here it is the sample's.
Error namingExemplar(const Error& error) {
    const std::string from = "`direction`";
    std::string text = error.what();
    const std::size_t at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), "`exemplarDirection`");
    return Error(error.code(), text);
}

ReliefSample sampleOfScan(const ReliefSource& source, const ReliefOptions& options, ReliefResult& result,
                          const RunContext& ctx) {
    ReliefExtractOptions extract;
    extract.base = options.base;
    extract.baseRadius = options.baseRadius;
    ReliefExtraction extraction = extractRelief(*source.scan, extract, ctx);
    if (result.baseRadius == 0) result.baseRadius = extraction.radius;
    auto fields = std::make_shared<const BaseSurface>(std::move(extraction.fields));
    PlaceDirections directions;
    if (options.exemplarDirection) {
        const VoxelPlace place = placeOf(*source.scan->grid, extraction.corner);
        directions = [place, source = *options.exemplarDirection, ctx](const std::vector<Vec3f>& point,
                                                                       const std::vector<Vec3f>& normal) {
            return directionsAt(point, normal, place, source, ctx);
        };
    }
    ReliefSampleOptions flat;
    if (options.wholeSample) flat.rough = 0;
    if (options.exemplarDirection) flat.maxRotation = kGivenReliefRotation;
    ReliefSample sample;
    try {
        sample = reliefSample(fields, directions, flat, ctx);
    } catch (const Error& error) {
        throw namingExemplar(error);
    }
    sample.corner = extraction.corner;
    result.covered.push_back(sample.covered);
    message(ctx, MessageLevel::Detail,
            "the sample is flattened to " + std::to_string(sample.charts) + " charts, " +
                std::to_string(sample.image.width) + " x " + std::to_string(sample.image.height) +
                " texels, that show " + roundedText(100 * sample.covered, 3) + " % of it; relief from " +
                roundedText(sample.lowest, 3) + " to " + roundedText(sample.highest, 3) + " voxels" +
                (sample.folds ? "; it folds, so distances are copied, not heights" : ""));
    if (sample.rough < kMostlyRough)
        message(ctx, MessageLevel::Note,
                roundedText(100 * (1 - sample.rough), 2) +
                    " % of the sample is plain and not copied; `wholeSample` copies it too");
    if (sample.covered < kFewCovered)
        message(ctx, MessageLevel::Warning,
                roundedText(100 * (1 - sample.covered), 2) +
                    " % of the sample is too curved to be flattened and is not copied; a larger `baseRadius` "
                    "makes its base smoother");
    return sample;
}

}  // namespace

ReliefSample preparedSample(const ReliefSource& source, double texel, double voxelSize,
                            const ReliefOptions& options, ReliefResult& result, const RunContext& ctx) {
    ReliefSample sample = source.scan ? sampleOfScan(source, options, result, ctx)
                                      : sampleOfPicture(source, texel, voxelSize, options, ctx);
    if (deviationOf(sample) < kNothing)
        throw Error(ErrorCode::Unusable,
                    source.scan ? "the sample has no relief at this scale: its surface is its base; a larger "
                                  "`baseRadius` or more voxels may find one"
                                : "the height picture has one height only: there is no relief to copy");
    return sample;
}

}  // namespace vdbsynth
