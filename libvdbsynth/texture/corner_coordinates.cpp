#include "libvdbsynth/texture/corner_coordinates.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// What coordinates of one chart may differ by: less shows as a stretch, more as a tear.
constexpr float kSlope = 0.5f, kTexels = 1;

// The copy of `at` in a tileable sample that is nearest to `wanted`.
Vec2f nearestCopy(const SampleImage& image, const Vec2f& at, const Vec2f& wanted) {
    if (!image.tileable) return at;
    const float w = float(image.width), h = float(image.height);
    return {at.x + w * std::round((wanted.x - at.x) / w), at.y + h * std::round((wanted.y - at.y) / h)};
}

// What one corner's chart makes of a triangle.
struct Chart {
    Vec2f at[3];
    int continued = 0;  // other corners that continue it
};

Chart chartOf(const TexturedSurface& surface, const Triangle& t, std::size_t corner) {
    Chart chart;
    const TexturedSites& sites = surface.sites;
    const std::int32_t sample = sites.sample[t[corner]];
    for (std::size_t k = 0; k < 3; ++k) {
        if (t[k] == t[corner]) {
            chart.at[k] = sites.coordinate[t[k]];
            continue;
        }
        const Vec2f wanted = chart.at[k] = extendedCoordinate(surface, t[corner], surface.point[t[k]]);
        if (sites.sample[t[k]] != sample) continue;
        const Vec2f own = nearestCopy(surface.samples[std::size_t(sample)], sites.coordinate[t[k]], wanted);
        const float across = length(surface.point[t[k]] - surface.point[t[corner]]) / float(surface.texel);
        if (!(length(own - wanted) <= kSlope * across + kTexels)) continue;
        chart.at[k] = own;
        ++chart.continued;
    }
    return chart;
}

// @return true if the triangle lies across charts
bool takeBest(const TexturedSurface& surface, const Triangle& t, Vec2f* at, std::int32_t& sample) {
    int best = -1;
    for (std::size_t corner = 0; corner < 3 && best < 2; ++corner) {
        if (surface.sites.sample[t[corner]] == TexturedSites::kNone) continue;
        const Chart chart = chartOf(surface, t, corner);
        if (chart.continued <= best) continue;
        best = chart.continued;
        sample = surface.sites.sample[t[corner]];
        std::copy(chart.at, chart.at + 3, at);
    }
    return best < 2;
}

}  // namespace

Vec2f extendedCoordinate(const TexturedSurface& surface, std::size_t site, const Vec3f& place) {
    const SiteFrame frame = siteFrame(surface.normal[site], surface.sites.tangent[site]);
    return surface.sites.coordinate[site] +
           flattened(frame, place - surface.point[site]) * float(1 / surface.texel);
}

CornerCoordinates cornerCoordinates(const TexturedSurface& surface, const std::vector<Triangle>& triangles,
                                    const RunContext& ctx) {
    CornerCoordinates result;
    result.coordinate.resize(3 * triangles.size());
    result.sample.assign(triangles.size(), TexturedSites::kNone);
    std::vector<char> torn(triangles.size(), 0);
    parallelFor(ctx, triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t)
            torn[t] = takeBest(surface, triangles[t], &result.coordinate[3 * t], result.sample[t]);
    });
    result.torn = std::size_t(std::count(torn.begin(), torn.end(), 1));
    return result;
}

}  // namespace vdbsynth
