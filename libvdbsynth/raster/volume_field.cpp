// What of a volume is solid; its voxels are in volume_field_cubes.cpp, height fields in height_field.cpp.
#include "libvdbsynth/raster/volume_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/crossing_field.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/raster/volume_field_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

std::string rounded(double value) {
    return roundedText(value, 6);
}

Index3 nearestSample(const Raster& raster, const Index3& p) {
    return {std::clamp(p.x, 0, raster.size.x - 1), std::clamp(p.y, 0, raster.size.y - 1),
            std::clamp(p.z, 0, raster.size.z - 1)};
}

// True if values change by about a sample's side from sample to sample wherever they cross the threshold.
bool isDistance(const Raster& raster, double threshold, double side) {
    constexpr double kMost = 0.2;  // change of the gradient's length: in creases it is shorter
    constexpr double kShare = 0.8;
    std::size_t near = 0, good = 0;
    forEachVoxel({{1, 1, 1}, raster.size - Index3{2, 2, 2}}, [&](const Index3& p) {
        const auto at = [&](int x, int y, int z) { return double(raster.at(p.x + x, p.y + y, p.z + z)); };
        if (!(std::abs(at(0, 0, 0) - threshold) < 0.5 * side)) return;
        const double x = at(1, 0, 0) - at(-1, 0, 0), y = at(0, 1, 0) - at(0, -1, 0),
                     z = at(0, 0, 1) - at(0, 0, -1);
        ++near;
        good += std::abs(std::sqrt(x * x + y * y + z * z) / (2 * side) - 1) < kMost;
    });
    return near > 0 && double(good) >= kShare * double(near);
}

// (threshold - value) times a scale over the box of the samples enlarged by the margin.
BrickField thresholdField(const Raster& raster, double threshold, double scale, const RunContext& ctx) {
    return crossingField(
        IndexBox::fromSize(raster.size).expanded(kRasterFieldMargin), kRasterFieldLimit, ctx,
        [&](const Index3& corner, const Index3& size, float* out) {
            forEachVoxel({corner, corner + size - Index3{1, 1, 1}}, [&](const Index3& voxel) {
                const Index3 p = nearestSample(raster, voxel);
                const float value = raster.at(p.x, p.y, p.z);
                *out++ = std::isnan(value) ? kRasterFieldLimit
                                           : std::clamp(float((threshold - double(value)) * scale),
                                                        -kRasterFieldLimit, kRasterFieldLimit);
            });
        });
}

// One pass of the binomial kernel 1 2 1 along each axis over a cube of kPadded, into one of kSide.
void smoothCube(const float* from, float* out) {
    constexpr int kPadded = kSide + 2;
    float alongX[kSide * kPadded * kPadded], alongY[kSide * kSide * kPadded];
    for (int i = 0; i < kSide * kPadded * kPadded; ++i)
        alongX[i] = 0.25f * (from[i] + 2 * from[i + kPadded * kPadded] + from[i + 2 * kPadded * kPadded]);
    for (int x = 0; x < kSide; ++x)
        for (int i = 0; i < kSide * kPadded; ++i) {
            const float* row = alongX + x * kPadded * kPadded + i;
            alongY[x * kSide * kPadded + i] = 0.25f * (row[0] + 2 * row[kPadded] + row[2 * kPadded]);
        }
    for (int i = 0; i < kSide * kSide; ++i)
        for (int z = 0; z < kSide; ++z) {
            const float* row = alongY + i * kPadded + z;
            *out++ = 0.25f * (row[0] + 2 * row[1] + row[2]);
        }
}

// Another field smoothed once: fill(values, smoothed) for every brick that is not constant with its
// neighbours; values are those of a cube of kPadded, smoothed those of the brick, which fill may change.
template <typename Change>
BrickField smoothedField(const BrickField& field, const RunContext& ctx, Change&& change) {
    constexpr int kPadded = kSide + 2;
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float constant = 0, padded[kPadded * kPadded * kPadded];
        if (field.constantIn(brick.expanded(1), constant)) {
            std::fill_n(samples, BrickField::kSamples, constant);
            return;
        }
        field.readBox(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        smoothCube(padded, samples);
        const Index3 corner = brick.min - Index3{1, 1, 1}, size{kPadded, kPadded, kPadded};
        forEachVoxel(brick, [&](const Index3& p) {
            *samples = change(p, padded[latticeIndex(p - corner, size)], *samples);
            ++samples;
        });
    });
}

// A field of -1/2 and 1/2 smoothed in some passes; after each, every sample is reset to its sign. A
// sample whose sign the first pass would change belongs to a thin part or a corner: it keeps that
// distance from the surface.
BrickField smoothedSides(const BrickField& sides, const RunContext& ctx) {
    constexpr int kPasses = 4;
    constexpr float kLeast = 0.04f, kMostThin = 0.45f;
    const auto beyond = [](float side, float value) {
        return (side < 0) == (value < 0) ? 0.f : std::abs(value);
    };
    // Unsmoothed samples hold 1/2, which no thin part reaches: 3/8 is that of a single sample.
    const BrickField thin = smoothedField(
        sides, ctx, [&](const Index3&, float side, float value) { return beyond(side, value); });
    BrickField field = sides;
    for (int pass = 0; pass < kPasses; ++pass)
        field = smoothedField(field, ctx, [&](const Index3& p, float side, float value) {
            const float own = std::abs(thin.at(p)), least = std::max(kLeast, own < kMostThin ? own : 0.f);
            return beyond(side, value) == 0 && std::abs(value) >= least ? value : std::copysign(least, side);
        });
    return field;
}

bool isOneOf(const std::vector<LabelRange>& labels, float value) {
    for (const auto& [low, high] : labels)
        if (double(value) >= low && double(value) <= high) return true;
    return false;
}

// [voxels] of some samples; those at the ends of the lattice reach half a voxel out.
template <typename Solid>
double volumeWhere(const Raster& raster, const Vec3d& cell, const Solid& solid) {
    const double smallest = std::min({cell.x, cell.y, cell.z});
    const auto side = [&](int i, int axis) {
        const double inner = cell[axis] / smallest;
        const int ends = (i == 0 ? 1 : 0) + (i == raster.size[axis] - 1 ? 1 : 0);
        return inner + ends * 0.5 * (1 - inner);
    };
    double volume = 0;
    forEachVoxel(IndexBox::fromSize(raster.size), [&](const Index3& p) {
        if (solid(raster.at(p.x, p.y, p.z))) volume += side(p.x, 0) * side(p.y, 1) * side(p.z, 2);
    });
    return volume;
}

// The field of the samples with one of some labels.
BrickField labelField(const std::string& name, const Raster& raster, const RasterRange& range,
                      const std::vector<LabelRange>& labels, const RunContext& ctx) {
    if (range.maximum > 16777215 || range.minimum < -16777215)
        throw Error(ErrorCode::Unusable, name + ": its values go up to " + rounded(range.maximum) +
                                             "; labels over 16777215 cannot be distinguished; renumber them");
    if (std::none_of(raster.values.begin(), raster.values.end(),
                     [&](float value) { return isOneOf(labels, value); }))
        throw Error(ErrorCode::Unusable, "`labels`: no sample of " + name +
                                             " has one of them; its values range from " +
                                             rounded(range.minimum) + " to " + rounded(range.maximum));
    const IndexBox box = IndexBox::fromSize(raster.size).expanded(kRasterFieldMargin);
    const BrickField smooth = smoothedSides(
        BrickField::fromVoxels(box, ctx,
                               [&](const Index3& voxel) {
                                   const Index3 p = nearestSample(raster, voxel);
                                   return isOneOf(labels, raster.at(p.x, p.y, p.z)) ? -0.5f : 0.5f;
                               }),
        ctx);
    return crossingField(
        box, kRasterFieldLimit, ctx,
        [&](const Index3& corner, const Index3& size, float* out) { smooth.readBox(corner, size, out); });
}

std::vector<LabelRange> chooseLabels(const std::string& name, const RasterRange& range,
                                     const VolumeOptions& options, std::string& description) {
    if (!options.labels.empty()) return options.labels;
    if (range.distinct.size() == 2) {
        description = "two values, of which " + rounded(range.maximum) + " is solid; `labels` changes that";
        return {{range.maximum, range.maximum}};
    }
    throw Error(ErrorCode::Unusable,
                name +
                    ": choose what is solid with `threshold` VALUE or `labels` LIST; its values range from " +
                    rounded(range.minimum) + " to " + rounded(range.maximum));
}

}  // namespace

void validate(const VolumeOptions& options) {
    if (options.threshold && !options.labels.empty())
        throw Error(ErrorCode::InvalidOption, "`threshold` and `labels`: give one of them");
    if (options.below && (options.threshold || !options.labels.empty()))
        throw Error(ErrorCode::InvalidOption, std::string("`below` and `") +
                                                  (options.threshold ? "threshold" : "labels") +
                                                  "`: give one of them");
    for (const auto& [value, field] : {std::pair(options.threshold, "threshold"), {options.below, "below"}})
        requireOption(!value || std::isfinite(*value), field, value ? exactText(*value) : "", "a number");
    for (const LabelRange& range : options.labels)
        requireOption(range.first <= range.second, "labels",
                      exactText(range.first) + ".." + exactText(range.second),
                      "a smaller and a larger value");
    requirePixelSize(options.pixelSize, options.pixelSides);
}

namespace {

// One channel, solid where its values are high; the raster itself if it is that, else made in `own`.
const Raster& risingInside(const Raster& given, bool below, Raster& own) {
    if (given.channels == 1 && !below) return given;
    own = luminance(given);
    if (below)
        for (float& value : own.values) value = -value;
    return own;
}

// @param threshold  of the values as risingInside returns them
void requireSurface(const std::string& name, const RasterRange& range, double threshold, bool below) {
    if (threshold >= range.minimum && threshold < range.maximum) return;
    throw Error(ErrorCode::Unusable,
                (below ? "`below` " + rounded(-threshold) : "`threshold` " + rounded(threshold)) +
                    ": no surface there; the values of " + name + " range from " +
                    rounded(below ? -range.maximum : range.minimum) + " to " +
                    rounded(below ? -range.minimum : range.maximum));
}

}  // namespace

RasterField volumeField(const std::string& name, const Raster& given, const VolumeOptions& options,
                        const RunContext& ctx) {
    validate(options);
    requireMemory(ctx, double(given.sampleCount()) * (options.below ? 16 : 12), name,
                  "crop or shrink it first");
    const Vec3d cell = cellSides(name, given, /* image= */ false, options.pixelSize, options.pixelSides);
    Stage stage(ctx, "volume to field", 1);
    Raster own;
    const Raster& raster = risingInside(given, options.below.has_value(), own);
    const RasterRange range = rangeOf(raster);
    if (range.infinite > 0)
        throw Error(ErrorCode::BadData,
                    name + ": " + std::to_string(range.infinite) + " values are infinite");
    if (range.missing == raster.values.size()) throw Error(ErrorCode::EmptyInput, name + ": has no data");
    RasterField result;
    if (options.threshold || options.below) {
        const double t = options.below ? -*options.below : *options.threshold;
        requireSurface(name, range, t, options.below.has_value());
        const double most = std::max(range.maximum - t, t - range.minimum);
        double scale = 0.999 * double(kRasterFieldLimit) / most;
        if (cell.x == cell.y && cell.y == cell.z && isDistance(raster, t, cell.x)) {
            scale = 1 / cell.x;
            result.distanceBand = float(std::min(0.999 * double(kRasterFieldLimit), most * scale));
        }
        result.field = thresholdField(raster, t, scale, ctx);
        // More values are samples of something smooth.
        if (range.distinct.size() == 2)
            result.solidVolume = volumeWhere(raster, cell, [&](float value) { return double(value) > t; });
    } else {
        const std::vector<LabelRange> labels = chooseLabels(name, range, options, result.description);
        const auto solid = [&](float value) { return isOneOf(labels, value); };
        result.solidVolume = volumeWhere(raster, cell, solid);
        result.field = labelField(name, raster, range, labels, ctx);
        if (range.distinct.size() == 2)
            result.keepsMore =
                "`threshold` " + rounded((range.minimum + range.maximum) / 2) + ", which smooths less, or ";
    }
    const bool inPlace = options.pixelSize <= 0 && options.pixelSides.x <= 0;
    if (inPlace && !given.knownSpacing)
        result.description += std::string(result.description.empty() ? "" : "; ") +
                              "it names no spacing, so samples are 1 apart (world); `pixelSize` changes that";
    placeField(name, raster, cell, inPlace, result, ctx);
    stage.advance();
    return result;
}

}  // namespace vdbsynth
