#include "tests/quality/texture_measures.h"

#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth::test {
namespace {

// Between two sorted lists of any lengths, by quantiles.
double wasserstein(const std::vector<float>& a, const std::vector<float>& b) {
    constexpr std::size_t kQuantiles = 2000;
    double sum = 0;
    for (std::size_t q = 0; q < kQuantiles; ++q) {
        const double t = (double(q) + 0.5) / double(kQuantiles);
        sum += std::abs(double(a[std::size_t(t * double(a.size()))]) -
                        double(b[std::size_t(t * double(b.size()))]));
    }
    return sum / double(kQuantiles);
}

std::vector<float> channelOf(const std::vector<float>& values, std::size_t channels, std::size_t c) {
    std::vector<float> out;
    for (std::size_t i = c; i < values.size(); i += channels) out.push_back(values[i]);
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<float> windowDraw(const SampleImage& sample, std::size_t count, std::uint64_t draw) {
    std::vector<float> values;
    const int side = std::min({32, sample.width, sample.height});
    for (std::uint64_t w = 0; values.size() < count * std::size_t(sample.channels); ++w) {
        Random random(draw, w, 77);
        const int x0 = int(random.below(std::uint32_t(sample.width - side + 1)));
        const int y0 = int(random.below(std::uint32_t(sample.height - side + 1)));
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                values.insert(values.end(), sample.texel(x0 + x, y0 + y),
                              sample.texel(x0 + x, y0 + y) + sample.channels);
    }
    values.resize(count * std::size_t(sample.channels));
    return values;
}

double histogramRatio(const TexturedSites& result, const SampleImage& sample) {
    const std::size_t channels = std::size_t(sample.channels);
    const std::size_t points = result.values.size() / channels;
    std::vector<std::vector<double>> draws(channels);
    for (std::uint64_t d = 0; d < 30; ++d) {
        const std::vector<float> values = windowDraw(sample, points, d);
        for (std::size_t c = 0; c < channels; ++c)
            draws[c].push_back(
                wasserstein(channelOf(values, channels, c), channelOf(sample.values, channels, c)));
    }
    double worst = 0;
    for (std::size_t c = 0; c < channels; ++c) {
        std::sort(draws[c].begin(), draws[c].end());
        const double median = (draws[c][14] + draws[c][15]) / 2;
        worst = std::max(
            worst, wasserstein(channelOf(result.values, channels, c), channelOf(sample.values, channels, c)) /
                       std::max(median, 1e-9));
    }
    return worst;
}

// As the result was read: a texel for each point.
void readTexel(const SampleImage& sample, const Vec2f& at, float* out) {
    std::copy_n(nearestTexel(sample, at), sample.channels, out);
}

double difference(const float* a, const float* b, int channels) {
    double sum = 0;
    for (int c = 0; c < channels; ++c) sum += double((a[c] - b[c]) * (a[c] - b[c]));
    return std::sqrt(sum);
}

// A place whose neighbourhood within `reach` is inside the given part of the sample.
Vec2f placeIn(const SampleImage& sample, Random& random, float reach, float x0, float y0, float x1,
              float y1) {
    const float w = float(sample.width), h = float(sample.height);
    const float left = x0 * w + reach, right = std::max(left + 0.01f, x1 * w - reach);
    const float low = y0 * h + reach, high = std::max(low + 0.01f, y1 * h - reach);
    return {float(random.uniform(left, right)), float(random.uniform(low, high))};
}

void steps(const SurfaceSites& sites, const TexturedSites& result, const SampleImage& sample, double texel,
           TextureNumbers& numbers) {
    const int channels = sample.channels;
    const std::size_t width = std::size_t(channels);
    double own = 0, plain = 0, seamOwn = 0, seamPlain = 0, pairs = 0, continued = 0;
    std::array<float, 16> a, b;
    for (std::size_t i = 0; i < sites.size(); ++i) {
        const SiteFrame frame = siteFrame(sites.normal[i], result.tangent[i]);
        for (std::size_t k = sites.begin[i]; k < std::min(sites.begin[i] + 4, sites.begin[i + 1]); ++k) {
            const std::uint32_t j = sites.neighbours[k];
            const Vec2f offset = flattened(frame, sites.point[j] - sites.point[i]) * float(1 / texel);
            Random random(5, i * 4 + k - sites.begin[i], 78);
            const float reach = std::min(length(offset), 0.2f * float(std::min(sample.width, sample.height)));
            const Vec2f at = placeIn(sample, random, reach, 0, 0, 1, 1);
            readTexel(sample, at, a.data());
            readTexel(sample, at + offset, b.data());
            const double d =
                difference(result.values.data() + i * width, result.values.data() + j * width, channels);
            const double e = difference(a.data(), b.data(), channels);
            own += d;
            plain += e;
            ++pairs;
            const bool continues = length(result.coordinate[i] + offset - result.coordinate[j]) < 0.5f;
            continued += continues;
            if (continues) continue;
            seamOwn += d;
            seamPlain += e;
        }
    }
    numbers.steps = own / std::max(plain, 1e-9);
    numbers.seams = seamPlain > 0 ? seamOwn / seamPlain : 1;
    numbers.coherent = continued / std::max(pairs, 1.0);
}

using Rows = std::vector<std::vector<float>>;

// The sample read through sites' neighbourhoods, at random places in a part of it.
Rows readThrough(const SampleImage& sample, const std::vector<std::vector<Vec2f>>& offsets,
                 std::uint64_t seed, float x0, float y0, float x1, float y1) {
    Rows rows;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
        float reach = 0;
        for (const Vec2f& o : offsets[i]) reach = std::max(reach, length(o));
        Random random(seed, i, 79);
        const Vec2f at = placeIn(sample, random, reach, x0, y0, x1, y1);
        std::vector<float> row(offsets[i].size() * std::size_t(sample.channels));
        for (std::size_t k = 0; k < offsets[i].size(); ++k)
            readTexel(sample, at + offsets[i][k], row.data() + k * std::size_t(sample.channels));
        rows.push_back(std::move(row));
    }
    return rows;
}

double sliced(const Rows& a, const Rows& b) {
    constexpr std::size_t kSlices = 48;
    double sum = 0;
    for (std::size_t s = 0; s < kSlices; ++s) {
        std::vector<float> axis(a[0].size());
        Random random(11, s, 80);
        double squared = 0;
        for (float& x : axis) {
            x = float(random.normal());
            squared += double(x * x);
        }
        const auto project = [&](const Rows& rows) {
            std::vector<float> out;
            for (const auto& row : rows) {
                double p = 0;
                for (std::size_t k = 0; k < axis.size(); ++k) p += double(axis[k] * row[k]);
                out.push_back(float(p / std::sqrt(squared)));
            }
            std::sort(out.begin(), out.end());
            return out;
        };
        sum += wasserstein(project(a), project(b));
    }
    return sum / double(kSlices);
}

// @param every  of a site's nearest one in so many counts, up to 25
double patchRatio(const SurfaceSites& sites, const TexturedSites& result, const SampleImage& sample,
                  double texel, std::size_t every) {
    constexpr std::size_t kPatches = 4000, kPoints = 25;
    const std::size_t width = std::size_t(sample.channels);
    std::vector<std::vector<Vec2f>> offsets;
    Rows own;
    for (std::size_t p = 0; p < kPatches; ++p) {
        Random random(3, p, 81);
        const std::size_t i = random.below(std::uint32_t(sites.size()));
        if (sites.degree(i) < kPoints * every) continue;
        const SiteFrame frame = siteFrame(sites.normal[i], result.tangent[i]);
        std::vector<Vec2f> places;
        std::vector<float> row;
        for (std::size_t k = sites.begin[i]; k < sites.begin[i] + kPoints * every; k += every) {
            const std::uint32_t j = sites.neighbours[k];
            places.push_back(flattened(frame, sites.point[j] - sites.point[i]) * float(1 / texel));
            row.insert(row.end(), result.values.begin() + std::ptrdiff_t(j * width),
                       result.values.begin() + std::ptrdiff_t((j + 1) * width));
        }
        offsets.push_back(std::move(places));
        own.push_back(std::move(row));
    }
    if (own.empty()) return 0;
    const Rows all = readThrough(sample, offsets, 1, 0, 0, 1, 1);
    const double halves = (sliced(readThrough(sample, offsets, 2, 0, 0, 0.5f, 1),
                                  readThrough(sample, offsets, 3, 0.5f, 0, 1, 1)) +
                           sliced(readThrough(sample, offsets, 4, 0, 0, 1, 0.5f),
                                  readThrough(sample, offsets, 5, 0, 0.5f, 1, 1))) /
                          2;
    return sliced(own, all) / std::max(halves, 1e-9);
}

}  // namespace

SampleImage sampleOf(const Raster& raster) {
    SampleImage image;
    image.width = raster.size.x;
    image.height = raster.size.y;
    image.channels = raster.channels;
    const float white = raster.white > 0 ? float(raster.white) : 1;
    for (int y = 0; y < image.height; ++y) {
        const int row = raster.rowsFromTop ? image.height - 1 - y : y;
        for (int k = 0; k < image.width * image.channels; ++k)
            image.values.push_back(
                raster.values[std::size_t(row) * std::size_t(image.width * image.channels) + std::size_t(k)] /
                white);
    }
    return image;
}

TextureNumbers textureNumbers(const TextureTarget& target, const TexturedSites& result,
                              const SampleImage& sample, double texel, const RunContext& ctx) {
    const SurfaceSites sites = sitesOfPoints(target.point, target.normal, 225, ctx);
    TextureNumbers numbers;
    numbers.histogram = histogramRatio(result, sample);
    steps(sites, result, sample, texel, numbers);
    numbers.patches = patchRatio(sites, result, sample, texel, 1);
    numbers.wide = patchRatio(sites, result, sample, texel, 9);
    return numbers;
}

}  // namespace vdbsynth::test
