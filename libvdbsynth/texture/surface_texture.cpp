// A stand-in for coordinate synthesis: every point is projected along the axis nearest to its normal.
#include "libvdbsynth/texture/surface_texture.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cmath>

namespace vdbsynth {
namespace {

int mainAxis(const Vec3f& n) {
    const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    return z >= x && z >= y ? 2 : y >= x ? 1 : 0;
}

void requireInputs(const TextureTarget& target, const std::vector<SampleImage>& samples,
                   const SurfaceTextureOptions& options) {
    requireOption(options.scale > 0 && options.scale < 1e30, "scale", roundedText(options.scale, 6),
                  "above 0");
    if (target.point.empty()) throw Error(ErrorCode::EmptyInput, "the target has no points");
    if (target.normal.size() != target.point.size())
        throw Error(ErrorCode::ShapeMismatch, "as many normals as points are needed");
    if (samples.empty() || samples[0].texels() == 0) throw Error(ErrorCode::EmptyInput, "an empty sample");
    for (const SampleImage& sample : samples)
        if (sample.channels != samples[0].channels)
            throw Error(ErrorCode::ShapeMismatch, "samples with different numbers of channels");
    for (std::int32_t label : target.label)
        if (label < 0 || std::size_t(label) >= samples.size())
            throw Error(ErrorCode::ShapeMismatch, "a label without a sample");
}

}  // namespace

SurfaceTextureResult textureSurface(const TextureTarget& target, const std::vector<SampleImage>& samples,
                                    const SurfaceTextureOptions& options, const RunContext& ctx) {
    requireInputs(target, samples, options);
    SurfaceTextureResult result;
    const std::size_t count = target.point.size(), channels = std::size_t(samples[0].channels);
    const double near = meanNearestDistance(sitesOfPoints(target.point, target.normal, 1, ctx));
    result.texel = options.texel > 0 ? options.texel : (near > 0 ? near : 1) * options.scale;
    TexturedSites& sites = result.sites;
    sites.sample.resize(count);
    sites.coordinate.resize(count);
    sites.tangent.resize(count);
    sites.values.resize(count * channels);
    sites.blended.assign(count, 0);
    parallelFor(ctx, count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3f& n = target.normal[i];
            const int axis = mainAxis(n);
            Vec3f s{0, 0, 0};
            s[(axis + 1) % 3] = 1;
            if (!target.direction.empty() && length(target.direction[i]) > 0) s = target.direction[i];
            const Vec3f tangent = tangentNear(n, s);
            const float side = n[axis] < 0 ? -1.f : 1.f;
            const Vec3f& p = target.point[i];
            sites.sample[i] = target.label.empty() ? 0 : target.label[i];
            sites.tangent[i] = tangent;
            const float texel = float(result.texel);
            sites.coordinate[i] = {p[(axis + 1) % 3] / texel, side * p[(axis + 2) % 3] / texel};
            readCubic(samples[std::size_t(sites.sample[i])], sites.coordinate[i],
                      sites.values.data() + i * channels);
        }
    });
    result.levels.push_back({count, 1, 1, 0});
    return result;
}

}  // namespace vdbsynth
