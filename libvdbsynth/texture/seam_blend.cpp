#include "libvdbsynth/texture/seam_blend.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <array>

namespace vdbsynth {
namespace {

constexpr float kOnePlace = 0.5f;  // [texels]
constexpr std::size_t kMostPlaces = 16;

// Places with their weights; those near each other are one.
class Places {
public:
    void add(const Vec2f& at, float weight) {
        for (std::size_t k = 0; k < mCount; ++k)
            if (length(mParts[k].at - at) <= kOnePlace) {
                mParts[k].weight += weight;
                return;
            }
        if (mCount < kMostPlaces) mParts[mCount++] = {at, weight};
    }
    std::size_t count() const { return mCount; }
    // The first place, which is the site's own, and the heaviest of the others.
    std::size_t heaviest() {
        std::stable_sort(mParts.begin() + 1, mParts.begin() + std::ptrdiff_t(mCount),
                         [](const BlendPart& a, const BlendPart& b) { return a.weight > b.weight; });
        return std::min(mCount, kMostBlendParts);
    }
    const BlendPart* parts() const { return mParts.data(); }

private:
    std::array<BlendPart, kMostPlaces> mParts;
    std::size_t mCount = 0;
};

Places placesAt(const CoordinateSites& sites, const CoordinateResult& coordinates, std::size_t i,
                double texel) {
    Places places;
    const SurfaceSites& graph = sites.sites;
    const std::size_t degree = graph.degree(i);
    if (degree == 0) return places;
    float mean = 0;
    for (std::size_t k = graph.begin[i]; k < graph.begin[i + 1]; ++k)
        mean += length(graph.point[graph.neighbours[k]] - graph.point[i]) / float(degree);
    places.add(coordinates.coordinate[i], 2 / mean);
    for (std::size_t k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
        const std::uint32_t j = graph.neighbours[k];
        if (!sites.label.empty() && sites.label[j] != sites.label[i]) continue;
        const Vec3f difference = graph.point[i] - graph.point[j];
        const SiteFrame frame = siteFrame(graph.normal[j], coordinates.tangent[j]);
        places.add(coordinates.coordinate[j] + flattened(frame, difference) * float(1 / texel),
                   1 / length(difference));
    }
    return places;
}

}  // namespace

std::size_t blendSeams(const CoordinateSites& sites, const CoordinateResult& coordinates,
                       const std::vector<SampleImage>& samples, double texel, std::vector<float>& values,
                       std::vector<char>& blended, const RunContext& ctx) {
    std::vector<HistogramBlend> blends;
    for (const SampleImage& sample : samples) blends.emplace_back(sample, ctx);
    const std::size_t channels = std::size_t(samples[0].channels);
    parallelFor(ctx, sites.sites.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Places places = placesAt(sites, coordinates, i, texel);
            if (places.count() < 2) continue;
            const std::size_t label = sites.label.empty() ? 0 : std::size_t(sites.label[i]);
            const std::size_t count = places.heaviest();
            blends[label].mix(places.parts(), count, values.data() + i * channels);
            blended[i] = 1;
        }
    });
    return std::size_t(std::count(blended.begin(), blended.end(), char(1)));
}

}  // namespace vdbsynth
