#include "libvdbsynth/pipeline/texture/texture.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/pipeline/texture/texture_steps.h"
#include "libvdbsynth/texture/point_hybrid.h"
#include "libvdbsynth/texture/point_matching.h"
#include "libvdbsynth/texture/point_parameterization.h"

#include <cmath>

namespace vdbsynth {
namespace {

const char* nameOf(TextureMethod method) {
    switch (method) {
        case TextureMethod::Default:
            return "default";
        case TextureMethod::Parameterize:
            return "parameterize";
        case TextureMethod::Match:
            return "match";
        case TextureMethod::Hybrid:
            return "hybrid";
    }
    return "";
}

TextureTarget targetOf(const TextureShape& shape, const std::vector<std::int32_t>& labels,
                       const TextureOptions& options, const RunContext& ctx) {
    TextureTarget target;
    target.point = shape.site;
    target.normal = shape.normal;
    target.label = labels;
    if (options.direction) target.direction = siteDirections(shape, *options.direction, ctx);
    return target;
}

void noteRegionBlend(const SurfaceTextureResult& made, double width, const RunContext& ctx) {
    if (made.regionBlended == 0)
        message(ctx, MessageLevel::Warning,
                "`regionBlend` has no effect: no point is within " + roundedText(width, 4) +
                    " pixels of another region along the surface");
    else
        message(ctx, MessageLevel::Note,
                std::to_string(made.regionBlended) +
                    " points near borders of regions mix images; repeat takes the one with the largest "
                    "weight");
}

TextureResult byCoordinates(const TextureTarget& target, const std::vector<SampleImage>& images,
                            const TextureOptions& options, const RunContext& ctx) {
    SurfaceTextureOptions surface;
    surface.scale = options.scale;
    surface.synthesis = options.synthesis;
    surface.synthesis.levels = options.levels;
    surface.blend = options.blend;
    surface.regionBlend = options.regionBlend;
    SurfaceTextureResult made = textureSurface(target, images, surface, ctx);
    if (options.regionBlend > 0) noteRegionBlend(made, options.regionBlend, ctx);
    return {std::move(made.sites), made.texel, options.scale > kMagnified, std::move(made.levels)};
}

TextureResult byParameterization(const TextureTarget& target, const SampleImage& image,
                                 const TextureOptions& options, const RunContext& ctx) {
    PointParameterizationOptions own;
    own.neighbours = options.neighbours;
    own.scale = options.scale;
    own.blend = options.blend;
    PointParameterizationResult made = parameterizePoints(target, image, own, ctx);
    message(ctx, MessageLevel::Note,
            std::to_string(made.patches) + (made.patches == 1 ? " patch" : " patches") + ", " +
                roundedText(100 * double(made.gaps) / double(target.point.size()), 3) +
                " % of the points in gaps between them, mixed " +
                (made.histogram ? "by histogram" : "by weight"));
    return {std::move(made.sites), made.texel, true, {}};
}

TextureResult byMatching(const TextureTarget& target, const SampleImage& image, const TextureOptions& options,
                         const RunContext& ctx) {
    PointMatchingOptions own;
    own.neighbours = options.neighbours;
    own.scale = options.scale;
    if (options.levels > 0) own.levels = options.levels;
    own.coherent = options.coherent;
    PointMatchingResult made = matchPoints(target, image, own, ctx);
    return {std::move(made.sites), made.texel, true, {}};
}

TextureResult byHybrid(const TextureTarget& target, const SampleImage& image, const TextureOptions& options,
                       const RunContext& ctx) {
    PointHybridOptions own;
    own.parameterization.neighbours = options.neighbours;
    own.parameterization.scale = options.scale;
    if (options.levels > 0) own.levels = options.levels;
    own.coherent = options.coherent;
    own.matchSample = options.matchSample;
    PointHybridResult made = texturePointsHybrid(target, image, own, ctx);
    const double points = double(target.point.size());
    message(ctx, MessageLevel::Note,
            std::to_string(made.patches) + (made.patches == 1 ? " patch" : " patches") + ", " +
                roundedText(100 * double(made.gaps) / points, 3) + " % of the points in gaps, " +
                roundedText(100 * double(made.widened) / points, 3) + " % when widened to features of " +
                roundedText(made.featureSize, 3) + " texels");
    return {std::move(made.sites), made.texel, true, {}};
}

// The one place where a method is chosen.
TextureResult byMethod(const TextureTarget& target, const std::vector<SampleImage>& images,
                       const TextureOptions& options, const RunContext& ctx) {
    if (options.method != TextureMethod::Default && images.size() > 1)
        throw Error(ErrorCode::InvalidOption, std::string("`method` ") + nameOf(options.method) +
                                                  ": takes one image; use default for several");
    switch (options.method) {
        case TextureMethod::Parameterize:
            return byParameterization(target, images[0], options, ctx);
        case TextureMethod::Match:
            return byMatching(target, images[0], options, ctx);
        case TextureMethod::Hybrid:
            return byHybrid(target, images[0], options, ctx);
        case TextureMethod::Default:
            break;
    }
    return byCoordinates(target, images, options, ctx);
}

}  // namespace

void validate(const TextureOptions& options) {
    requireOption(options.scale >= 0.01 && options.scale <= 100, "scale", roundedText(options.scale, 6),
                  "a number from 0.01 to 100");
    requireOption(options.neighbours >= 4 && options.neighbours <= 128, "neighbours",
                  std::to_string(options.neighbours), "a whole number from 4 to 128");
    requireOption(options.levels >= 0 && options.levels <= 12, "levels", std::to_string(options.levels),
                  "a whole number from 1 to 12");
    requireOption(options.regionBlend >= 0 && options.regionBlend <= kWidestRegionBlend, "regionBlend",
                  roundedText(options.regionBlend, 6), "a number from 0 to 1000 (pixels)");
    requireOption(options.matchSample == 0 || options.matchSample >= kSmallestSample, "matchSample",
                  std::to_string(options.matchSample), "at least 4 (texels)");
    const TextureMethod method = options.method;
    const SampleBlend blend = options.blend;
    const bool mixes = method == TextureMethod::Default || method == TextureMethod::Parameterize;
    requireOption(blend == SampleBlend::Automatic || mixes, "blend", "given",
                  "left out: method " + std::string(nameOf(method)) + " mixes nothing");
    requireOption(blend != SampleBlend::Off || method == TextureMethod::Default, "blend", "off",
                  "auto, weight or histogram: gaps between patches are mixed");
    requireOption(blend != SampleBlend::Weight || method == TextureMethod::Parameterize, "blend", "weight",
                  "off, auto or histogram");
    if (options.direction) requireDirection(*options.direction, "direction");
}

std::vector<SampleImage> imagesOf(const std::vector<TextureSample>& samples) {
    std::vector<SampleImage> images;
    for (const TextureSample& sample : samples) images.push_back(sample.image);
    return images;
}

TextureResult textureShape(const TextureShape& shape, const std::vector<TextureSample>& samples,
                           const std::vector<std::int32_t>& labels, const TextureOptions& options,
                           const RunContext& ctx) {
    validate(options);
    return withThreads(ctx, [&] {
        const TextureTarget target = targetOf(shape, labels, options, ctx);
        return byMethod(target, imagesOf(samples), options, ctx);
    });
}

void displace(TextureShape& shape, const TextureResult& result, const std::vector<TextureSample>& samples,
              const std::string& map, double amplitude) {
    const SampleMap* found = nullptr;
    for (const SampleMap& of : samples.front().maps)
        if (of.name == map) found = &of;
    requireOption(std::abs(amplitude) < 1e18, "amplitude", roundedText(amplitude, 6), "within 1e18 (world)");
    requireOption(found != nullptr, "displace", map, "the name of a map of the sample");
    const std::size_t channels = std::size_t(samples.front().image.channels),
                      first = std::size_t(found->first);
    shape.moved = shape.site;
    for (std::size_t i = 0; i < shape.site.size(); ++i) {
        const float height = result.sites.values[i * channels + first];
        shape.moved[i] = shape.site[i] + shape.normal[i] * float(amplitude * double(height));
    }
    for (std::size_t e = 0; e < shape.points.size(); ++e) shape.points[e] = shape.moved[shape.siteOf[e]];
}

}  // namespace vdbsynth
