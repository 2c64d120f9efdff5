#include "libvdbsynth/texture/surface_texture.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/coordinates/site_tangents.h"
#include "libvdbsynth/texture/region_blend.h"
#include "libvdbsynth/texture/seam_blend.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace vdbsynth {
namespace {

// Points that coincide and face the same way, as one.
struct Welded {
    TextureTarget target;
    std::vector<std::uint32_t> place;  // [points] in the welded target
};

// @param first  [points] the point that stands for each; places: those that stand for themselves
Welded gathered(const TextureTarget& target, const std::vector<std::uint32_t>& places,
                const std::vector<std::uint32_t>& first, const RunContext& ctx) {
    Welded out;
    TextureTarget& welded = out.target;
    out.place.resize(target.point.size());
    welded.point.resize(places.size());
    welded.normal.resize(places.size());
    if (!target.direction.empty()) welded.direction.resize(places.size());
    if (!target.label.empty()) welded.label.resize(places.size());
    parallelFor(ctx, places.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
            const std::uint32_t i = places[p];
            out.place[i] = std::uint32_t(p);
            welded.point[p] = target.point[i];
            welded.normal[p] = normalized(target.normal[i]);
            if (!target.direction.empty()) welded.direction[p] = target.direction[i];
            if (!target.label.empty()) welded.label[p] = target.label[i];
        }
    });
    // One that stands for others has its place from above, so that writing it again changes nothing.
    for (std::uint32_t i = 0; i < first.size(); ++i) out.place[i] = out.place[first[i]];
    return out;
}

struct Numbered {
    Vec3f point;
    std::uint32_t number = 0;
};

Welded welded(const TextureTarget& target, const RunContext& ctx) {
    // Copies, as sorting numbers would fetch each point from anywhere in memory.
    std::vector<Numbered> order(target.point.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = {target.point[i], i};
    parallelSort(ctx, order, [](const Numbered& a, const Numbered& b) {
        return std::tie(a.point.x, a.point.y, a.point.z, a.number) <
               std::tie(b.point.x, b.point.y, b.point.z, b.number);
    });
    const auto key = [](const Numbered& a) { return std::tie(a.point.x, a.point.y, a.point.z); };
    std::vector<std::uint32_t> first(target.point.size());
    std::vector<std::uint32_t> kept;  // at one place: they face different ways, so they are few
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        kept.clear();
        for (end = begin; end < order.size() && key(order[end]) == key(order[begin]); ++end) {
            const auto same = std::find_if(kept.begin(), kept.end(), [&](std::uint32_t k) {
                return dot(target.normal[k], target.normal[order[end].number]) > 0;
            });
            first[order[end].number] = same == kept.end() ? order[end].number : *same;
            if (same == kept.end()) kept.push_back(order[end].number);
        }
    }
    std::vector<std::uint32_t> places = mortonOrder(target.point, ctx);  // neighbours near in memory
    places.erase(std::remove_if(places.begin(), places.end(), [&](std::uint32_t i) { return first[i] != i; }),
                 places.end());
    return gathered(target, places, first, ctx);
}

// Sites as sparse as the texels take a texel each, so that the sample's contrast and histogram stay; reading
// between texels would cost fine textures a third of their contrast. Denser sites are read smoothly.
void readValues(TexturedSites& sites, const std::vector<SampleImage>& samples, bool dense,
                const RunContext& ctx) {
    const std::size_t channels = std::size_t(samples[0].channels);
    sites.values.resize(sites.coordinate.size() * channels);
    parallelFor(ctx, sites.coordinate.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const SampleImage& sample = samples[std::size_t(sites.sample[i])];
            float* out = sites.values.data() + i * channels;
            if (dense)
                readCubic(sample, sites.coordinate[i], out);
            else
                std::copy_n(nearestTexel(sample, sites.coordinate[i]), channels, out);
        }
    });
}

TexturedSites placedSites(const CoordinateSites& sites, const CoordinateResult& coordinates) {
    TexturedSites placed;
    placed.sample = sites.label;
    placed.sample.resize(sites.sites.size(), 0);
    placed.coordinate = coordinates.coordinate;
    placed.tangent = coordinates.tangent;
    placed.blended.assign(sites.sites.size(), 0);
    return placed;
}

// One for each point from one for each place.
TexturedSites spreadOut(const TexturedSites& placed, const std::vector<std::uint32_t>& place,
                        std::size_t channels, const RunContext& ctx) {
    TexturedSites out;
    out.values.resize(place.size() * channels);
    out.sample.resize(place.size());
    out.coordinate.resize(place.size());
    out.tangent.resize(place.size());
    out.blended.resize(place.size());
    parallelFor(ctx, place.size(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t p = place[i];
            out.sample[i] = placed.sample[p];
            out.coordinate[i] = placed.coordinate[p];
            out.tangent[i] = placed.tangent[p];
            out.blended[i] = placed.blended[p];
            std::copy_n(placed.values.data() + p * channels, channels, out.values.data() + i * channels);
        }
    });
    return out;
}

bool mixesSeams(const std::vector<SampleImage>& samples, SampleBlend blend, const RunContext& ctx) {
    if (blend != SampleBlend::Automatic) return blend == SampleBlend::Histogram;
    bool suits = true;
    for (const SampleImage& sample : samples) {
        const double loss = blendLoss(sample, ctx);
        suits = suits && loss <= kBlendSuits;
        message(ctx, MessageLevel::Detail,
                "a mix of two places of the sample differs from it " + roundedText(loss, 3) +
                    " times as much as one place does; " +
                    (loss <= kBlendSuits
                         ? "colours are mixed where charts meet"
                         : "colours are not mixed (the limit is " + roundedText(kBlendSuits, 3) + ")"));
    }
    return suits;
}

void requireOptions(const SurfaceTextureOptions& options) {
    if (!(options.texel >= 0) || !std::isfinite(options.texel))
        throw Error(ErrorCode::InvalidOption, "`texel`: is below 0");
    if (!(options.scale > 0) || !std::isfinite(options.scale))
        throw Error(ErrorCode::InvalidOption, "`scale`: is not above 0");
    if (!(options.regionBlend >= 0 && options.regionBlend <= kWidestRegionBlend))
        throw Error(ErrorCode::InvalidOption, "`regionBlend`: is not from 0 to 1000 (texels)");
    if (options.blend == SampleBlend::Weight)
        throw Error(ErrorCode::InvalidOption, "`blend`: by weight is of the parameterization only");
    validate(options.synthesis);
}

}  // namespace

void requireTarget(const TextureTarget& target) {
    const std::size_t n = target.point.size();
    if (n == 0) throw Error(ErrorCode::EmptyInput, "there are no points");
    if (target.normal.size() != n || (!target.direction.empty() && target.direction.size() != n) ||
        (!target.label.empty() && target.label.size() != n))
        throw Error(ErrorCode::ShapeMismatch, "points, normals, directions and labels differ in number");
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3f &p = target.point[i], &m = target.normal[i];
        if (!std::isfinite(p.x + p.y + p.z) || !std::isfinite(m.x + m.y + m.z) || !(dot(m, m) > 0))
            throw Error(ErrorCode::Unusable,
                        "point " + std::to_string(i) + " is not finite, or has no normal");
    }
}

SurfaceTextureResult textureSurface(const TextureTarget& target, const std::vector<SampleImage>& samples,
                                    const SurfaceTextureOptions& options, const RunContext& ctx) {
    requireOptions(options);
    requireTarget(target);
    return withThreads(ctx, [&] {
        Welded whole = welded(target, ctx);
        CoordinateSites sites;
        sites.sites = sitesOfPoints(std::move(whole.target.point), std::move(whole.target.normal),
                                    kSiteNeighbours, ctx);
        const double spacing = meanNearestDistance(sites.sites);
        SurfaceTextureResult result;
        // A single point, or all at one place, has no spacing; any texel serves.
        const double unit = spacing > 0 ? spacing : 1;
        result.texel = options.texel > 0 ? options.texel : unit * options.scale;
        sites.tangent = siteTangents(sites.sites, whole.target.direction, unit, &result.singularities, ctx);
        sites.label = std::move(whole.target.label);
        CoordinateOptions synthesis = options.synthesis;
        if (anyDirection(whole.target.direction))
            synthesis.maxRotation = std::min(synthesis.maxRotation, kGivenRotation);
        const std::vector<std::int32_t> label = sites.label;
        const CoordinateResult coordinates =
            synthesizeCoordinates(sites, samples, result.texel, synthesis, ctx);
        result.levels = coordinates.levels;
        const bool dense = result.texel > kMagnified * unit;
        TexturedSites placed = placedSites(sites, coordinates);
        readValues(placed, samples, dense, ctx);
        if (!dense && mixesSeams(samples, options.blend, ctx))
            result.blended =
                blendSeams(sites, coordinates, samples, result.texel, placed.values, placed.blended, ctx);
        if (options.regionBlend > 0)
            result.regionBlended =
                blendRegions(sites, coordinates, samples, result.texel, options.regionBlend, dense,
                             placed.values, placed.blended, ctx);
        result.sites = spreadOut(placed, whole.place, std::size_t(samples[0].channels), ctx);
        return result;
    });
}

}  // namespace vdbsynth
