#include "libvdbsynth/relief/transfer/relief_sample.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_tangents.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/relief/transfer/relief_sample_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSpacing = 1;       // [voxels] between vertices of a zero level
constexpr float kMostOverlap = 48;   // [voxels]
constexpr double kFoldsFrom = 0.01;  // share of the texels that fold, from which distances are copied
constexpr double kRoughRadii = 1.5;  // of the base, around a place, that tell how rough it is
constexpr float kHidden = 2;         // [voxels] to which the distances above and below are clamped

// What lies over every texel of an atlas.
std::vector<ReliefPoint> readRelief(const ReliefSample& sample, const RunContext& ctx) {
    std::vector<ReliefPoint> out(sample.image.texels());
    Stage stage(ctx, "relief of the sample", 1);
    parallelFor(ctx, out.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (sample.known[i]) out[i] = reliefAt(*sample.surface, sample.place[i], sample.normal[i]);
    });
    stage.advance();
    return out;
}

// Heights, and where the sample folds what is below and above.
void fillChannels(ReliefSample& sample, const RunContext& ctx) {
    const std::vector<ReliefPoint> relief = readRelief(sample, ctx);
    SampleImage& image = sample.image;
    std::size_t folded = 0, counted = 0;
    for (std::size_t i = 0; i < relief.size(); ++i) {
        if (!sample.known[i]) continue;
        ++counted;
        folded += relief[i].folds;
        sample.lowest = std::min(sample.lowest, relief[i].height);
        sample.highest = std::max(sample.highest, relief[i].height);
    }
    sample.folds = double(folded) > kFoldsFrom * double(counted);
    if (sample.folds) {
        sample.lowest = std::min(sample.lowest, -float(sample.surface->amplitude));
        sample.highest = std::max(sample.highest, float(sample.surface->amplitude));
    }
    image.channels = sample.folds ? 3 : 1;
    image.values.assign(image.texels() * std::size_t(image.channels), 0);
    parallelFor(ctx, image.texels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (!sample.known[i]) continue;
            float* out = image.values.data() + i * std::size_t(image.channels);
            out[0] = relief[i].lost ? 0 : relief[i].height;
            for (int side = 1; side < image.channels; ++side) {
                const float depth = 0.5f * (side == 1 ? sample.lowest : sample.highest);
                out[side] = std::clamp(
                    sampleTrilinear(sample.surface->scan, sample.place[i] + sample.normal[i] * depth),
                    -kHidden, kHidden);
            }
        }
    });
}

}  // namespace

ReliefSample reliefSample(std::shared_ptr<const BaseSurface> base, const PlaceDirections& directions,
                          const ReliefSampleOptions& options, const RunContext& ctx) {
    const Mesh mesh = zeroLevel(base->distance, base->distance.box(), Facing::Outward, ctx);
    if (mesh.points.empty()) throw Error(ErrorCode::EmptyInput, "the sample's base has no surface");
    std::vector<Vec3f> normals(mesh.points.size());
    parallelFor(ctx, normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f gradient = normalized(sampleGradient(base->distance, mesh.points[i]));
            normals[i] = dot(gradient, gradient) > 0 ? gradient : Vec3f{0, 0, 1};
        }
    });
    const SurfaceSites sites = sitesOfPoints(mesh.points, normals, 8, ctx);
    const std::vector<Vec3f> wanted = directions ? directions(mesh.points, normals) : std::vector<Vec3f>{};
    const std::vector<Vec3f> tangents = siteTangents(sites, wanted, kSpacing, nullptr, ctx);
    ReliefChartOptions charting;
    charting.maxRotation = options.maxRotation;
    charting.overlap = std::min(kMostOverlap, float(2 * base->radius));
    const std::vector<ReliefChart> charts = layReliefCharts(sites, tangents, kSpacing, charting, ctx);
    ReliefSample sample;
    sample.surface = std::move(base);
    sample.directions = directions;
    sample.charts = charts.size();
    packCharts(charts, triangulated(mesh), sites, options.largest, sample, ctx);
    fillChannels(sample, ctx);
    leavePlainOut(sample, options.rough, kRoughRadii * sample.surface->radius, ctx);
    continueBeyondCharts(sample, ctx);
    return sample;
}

ReliefSample reliefSample(SampleImage heights) {
    if (heights.texels() == 0) throw Error(ErrorCode::EmptyInput, "the height picture has no pixels");
    if (heights.channels != 1) throw Error(ErrorCode::ShapeMismatch, "a height picture has one channel");
    ReliefSample sample;
    for (std::size_t i = 0; i < heights.texels(); ++i) {
        if (!heights.valid.empty() && !heights.valid[i]) continue;
        const float h = heights.values[i];
        if (!std::isfinite(h))
            throw Error(ErrorCode::BadData, "the height picture has values that are not finite");
        sample.lowest = std::min(sample.lowest, h);
        sample.highest = std::max(sample.highest, h);
    }
    sample.image = std::move(heights);
    return sample;
}

void withChannels(ReliefSample& sample, bool folds) {
    SampleImage& image = sample.image;
    const std::size_t from = std::size_t(image.channels), to = folds ? 3 : 1;
    if (from == to) return;
    std::vector<float> values(image.texels() * to);
    for (std::size_t i = 0; i < image.texels(); ++i) {
        const float h = image.values[i * from];
        values[i * to] = h;
        // A height is solid up to h and void above.
        for (std::size_t side = 1; side < to; ++side)
            values[i * to + side] =
                std::clamp(0.5f * (side == 1 ? sample.lowest : sample.highest) - h, -kHidden, kHidden);
    }
    image.values = std::move(values);
    image.channels = int(to);
}

Vec3f reliefPlace(const ReliefSample& sample, const Vec2f& at) {
    return placeAt(sample, at).place;
}

float reliefDistance(const ReliefSample& sample, const Vec2f& at, float depth) {
    if (!sample.folds) {
        // Heights between texels, and the slope for a distance to first order.
        float h, east, west, north, south;
        const auto read = [&](const Vec2f& where, float& out) {
            if (sample.image.channels == 1) return readCubic(sample.image, where, &out);
            float all[3];
            readCubic(sample.image, where, all);
            out = all[0];
        };
        read(at, h);
        read(at + Vec2f{0.5f, 0}, east);
        read(at - Vec2f{0.5f, 0}, west);
        read(at + Vec2f{0, 0.5f}, north);
        read(at - Vec2f{0, 0.5f}, south);
        const float dx = east - west, dy = north - south;
        return (depth - h) / std::sqrt(1 + dx * dx + dy * dy);
    }
    const Placed3 on = placeAt(sample, at);
    return sampleTrilinear(sample.surface->scan, on.place + on.normal * depth);
}

}  // namespace vdbsynth
