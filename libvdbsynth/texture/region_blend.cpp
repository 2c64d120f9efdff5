#include "libvdbsynth/texture/region_blend.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

namespace vdbsynth {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// How another label's region is reached from a site.
struct Reach {
    std::uint32_t site = 0;
    std::int32_t label = 0;
    std::uint32_t from = 0;  // the label's nearest site
    double distance = 0;     // [world] to that site; in the end to the border
};

bool later(const Reach& a, const Reach& b) {
    return std::tie(a.distance, a.from, a.site) > std::tie(b.distance, b.from, b.site);
}

// Edges across borders, each from both ends, by label.
std::vector<Reach> crossings(const CoordinateSites& sites) {
    const SurfaceSites& graph = sites.sites;
    std::vector<Reach> across;
    for (std::uint32_t i = 0; i < graph.size(); ++i)
        for (std::uint32_t k = graph.begin[i]; k < graph.begin[i + 1]; ++k) {
            const std::uint32_t j = graph.neighbours[k];
            if (sites.label[i] == sites.label[j]) continue;
            const double edge = double(length(graph.point[j] - graph.point[i]));
            across.push_back({i, sites.label[j], j, edge});
            across.push_back({j, sites.label[i], i, edge});
        }
    std::sort(across.begin(), across.end(), [](const Reach& a, const Reach& b) {
        return a.label != b.label ? a.label < b.label : later(b, a);
    });
    return across;
}

// Adds the sites within `width` of one label's sites.
// @param distance  [sites] kFar, and so again afterwards
void spreadFrom(const CoordinateSites& sites, const Reach* begin, const Reach* end, double width,
                std::vector<double>& distance, std::vector<Reach>& reached) {
    const SurfaceSites& graph = sites.sites;
    std::priority_queue<Reach, std::vector<Reach>, bool (*)(const Reach&, const Reach&)> queue(later);
    for (const Reach* at = begin; at != end; ++at)
        if (at->distance < width) queue.push(*at);
    const std::size_t first = reached.size();
    while (!queue.empty()) {
        const Reach here = queue.top();
        queue.pop();
        if (distance[here.site] < kFar) continue;  // settled, from no farther
        distance[here.site] = here.distance;
        reached.push_back(here);
        for (std::uint32_t k = graph.begin[here.site]; k < graph.begin[here.site + 1]; ++k) {
            Reach next = here;
            next.site = graph.neighbours[k];
            next.distance += double(length(graph.point[next.site] - graph.point[here.site]));
            if (sites.label[next.site] != here.label && next.distance < width && distance[next.site] == kFar)
                queue.push(next);
        }
    }
    for (std::size_t k = first; k < reached.size(); ++k) distance[reached[k].site] = kFar;
}

// By site, then by label. The border is half a mean distance of neighbours before the other label's sites.
std::vector<Reach> reaches(const CoordinateSites& sites, double width, const RunContext& ctx) {
    const double half = 0.5 * meanNearestDistance(sites.sites);
    const std::vector<Reach> across = crossings(sites);
    std::vector<double> distance(sites.sites.size(), kFar);
    std::vector<Reach> reached;
    for (std::size_t begin = 0, end = 0; begin < across.size(); begin = end) {
        throwIfCancelled(ctx);
        while (end < across.size() && across[end].label == across[begin].label) ++end;
        spreadFrom(sites, &across[begin], across.data() + end, width + half, distance, reached);
    }
    for (Reach& reach : reached) reach.distance = std::max(0.0, reach.distance - half);
    std::sort(reached.begin(), reached.end(), [](const Reach& a, const Reach& b) {
        return std::tie(a.site, a.label) < std::tie(b.site, b.label);
    });
    return reached;
}

double smooth(double t) {
    return t * t * (3 - 2 * t);
}

class Mixer {
public:
    Mixer(const CoordinateSites& sites, const CoordinateResult& coordinates,
          const std::vector<SampleImage>& samples, double texel, double width, bool dense)
        : mSites(sites.sites),
          mCoordinates(coordinates),
          mSamples(samples),
          mTexel(texel),
          mWidth(width),
          mDense(dense) {}

    // All reaches of one site. @param values  its own, changed
    void mix(const Reach* begin, const Reach* end, float* values) const {
        const std::size_t channels = std::size_t(mSamples[0].channels);
        double nearest = mWidth;
        for (const Reach* at = begin; at != end; ++at) nearest = std::min(nearest, at->distance);
        double whole = smooth((mWidth + nearest) / (2 * mWidth));
        std::vector<double> sum(channels);
        for (std::size_t c = 0; c < channels; ++c) sum[c] = whole * double(values[c]);
        std::vector<float> other(channels);
        for (const Reach* at = begin; at != end; ++at) {
            const double weight = smooth((mWidth - at->distance) / (2 * mWidth));
            read(*at, other.data());
            whole += weight;
            for (std::size_t c = 0; c < channels; ++c) sum[c] += weight * double(other[c]);
        }
        for (std::size_t c = 0; c < channels; ++c) values[c] = float(sum[c] / whole);
    }

private:
    void read(const Reach& reach, float* values) const {
        const SampleImage& sample = mSamples[std::size_t(reach.label)];
        const SiteFrame frame = siteFrame(mSites.normal[reach.from], mCoordinates.tangent[reach.from]);
        const Vec3f across = mSites.point[reach.site] - mSites.point[reach.from];
        const Vec2f at = mCoordinates.coordinate[reach.from] + flattened(frame, across) * float(1 / mTexel);
        if (mDense)
            readCubic(sample, at, values);
        else
            std::copy_n(nearestTexel(sample, at), sample.channels, values);
    }

    const SurfaceSites& mSites;
    const CoordinateResult& mCoordinates;
    const std::vector<SampleImage>& mSamples;
    double mTexel, mWidth;  // the width [world]
    bool mDense;
};

}  // namespace

std::size_t blendRegions(const CoordinateSites& sites, const CoordinateResult& coordinates,
                         const std::vector<SampleImage>& samples, double texel, double width, bool dense,
                         std::vector<float>& values, std::vector<char>& blended, const RunContext& ctx) {
    requireOption(width > 0 && std::isfinite(width), "width", roundedText(width, 6), "above 0 (texels)");
    if (sites.label.empty()) return 0;
    const std::vector<Reach> reached = reaches(sites, width * texel, ctx);
    std::vector<std::size_t> begins;
    for (std::size_t k = 0; k < reached.size(); ++k)
        if (k == 0 || reached[k].site != reached[k - 1].site) begins.push_back(k);
    const std::size_t count = begins.size(), channels = std::size_t(samples[0].channels);
    begins.push_back(reached.size());
    const Mixer mixer(sites, coordinates, samples, texel, width * texel, dense);
    parallelFor(ctx, count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const std::uint32_t site = reached[begins[s]].site;
            mixer.mix(reached.data() + begins[s], reached.data() + begins[s + 1],
                      values.data() + site * channels);
            blended[site] = 1;
        }
    });
    return count;
}

}  // namespace vdbsynth
