#include "libvdbsynth/coordinates/sample_features.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

constexpr int kWindow = 2;             // places on each side of the middle
constexpr std::size_t kFitted = 4096;  // windows from which principal axes are found

// Writes a node's vector. Called from many threads.
using VectorOf = std::function<void(std::int32_t node, float* out)>;

// The `count` principal axes of the vectors of at most kFitted nodes, evenly chosen; beyond the vectors'
// length they are zero.
PrincipalAxes axesOf(const std::vector<std::int32_t>& nodes, std::size_t length, std::size_t count,
                     const VectorOf& vectorOf) {
    const std::size_t fitted = std::min(nodes.size(), kFitted);
    std::vector<float> some(fitted * length);
    for (std::size_t i = 0; i < fitted; ++i)
        vectorOf(nodes[i * nodes.size() / fitted], some.data() + i * length);
    PrincipalAxes axes = principalAxes(some, length, count, 2);
    axes.axes.resize(count * length, 0);
    axes.count = count;
    return axes;
}

std::vector<float> projectAll(const PrincipalAxes& axes, std::size_t nodes, const VectorOf& vectorOf,
                              const RunContext& ctx) {
    std::vector<float> out(nodes * axes.count);
    parallelFor(ctx, nodes, 1024, [&](std::size_t begin, std::size_t end) {
        std::vector<float> vector(axes.length);
        for (std::size_t i = begin; i < end; ++i) {
            vectorOf(std::int32_t(i), vector.data());
            axes.project(vector.data(), out.data() + i * axes.count);
        }
    });
    return out;
}

// The 5 x 5 window of a node, the outer places with less weight.
class Windows {
public:
    /// @param image  a texel for each node
    Windows(const SampleImage& image, const SampleLevel& level)
        : mImage(image), mWidth(level.width), mStep(float(level.step / double(level.stride))) {
        for (int dy = -kWindow; dy <= kWindow; ++dy)
            for (int dx = -kWindow; dx <= kWindow; ++dx)
                mWeight.push_back(float(exponential(-double(dx * dx + dy * dy) / 8)));
    }

    std::size_t length() const { return mWeight.size() * std::size_t(mImage.channels); }

    void operator()(std::int32_t node, float* out) const {
        const Vec2f at{float(node % mWidth) + 0.5f, float(node / mWidth) + 0.5f};
        std::size_t place = 0;
        for (int dy = -kWindow; dy <= kWindow; ++dy)
            for (int dx = -kWindow; dx <= kWindow; ++dx, ++place, out += mImage.channels) {
                readLinear(mImage, at + Vec2f{float(dx), float(dy)} * mStep, out);
                for (int c = 0; c < mImage.channels; ++c) out[c] *= mWeight[place];
            }
    }

private:
    const SampleImage& mImage;
    int mWidth;
    float mStep;
    std::vector<float> mWeight;
};

// Of every node and channel the sixteenth of the values that it belongs to; equal values share one.
std::vector<std::uint8_t> ranksOf(const SampleImage& image) {
    const std::size_t nodes = image.texels(), channels = std::size_t(image.channels);
    const std::vector<float>& values = image.values;
    std::vector<std::uint8_t> ranks(values.size());
    std::vector<float> sorted(nodes);
    for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < nodes; ++i) sorted[i] = values[i * channels + c];
        std::sort(sorted.begin(), sorted.end());
        for (std::size_t i = 0; i < nodes; ++i) {
            const auto below = std::lower_bound(sorted.begin(), sorted.end(), values[i * channels + c]);
            ranks[i * channels + c] = std::uint8_t(std::size_t(below - sorted.begin()) * kRanks / nodes);
        }
    }
    return ranks;
}

// The appearances at the four taps around a node.
void tapsAround(const SampleLevel& level, std::int32_t node, float* out) {
    for (std::size_t t = 0; t < 4; ++t) {
        const Vec2f at = level.centre(node) + kTaps[t] * float(level.step);
        std::copy_n(level.appearance.data() + std::size_t(level.node(at)) * kAppearance, kAppearance,
                    out + t * kAppearance);
    }
}

// One pass of the smoothing, along columns or rows.
void smoothAlong(const SampleImage& from, SampleImage& to, const std::vector<float>& kernel, bool columns,
                 const RunContext& ctx) {
    const int reach = int(kernel.size()) - 1, channels = from.channels;
    const int side = columns ? from.width : from.height;
    std::vector<int> folded;
    for (int at = -reach; at < side + reach; ++at) folded.push_back(foldedTexel(at, side, from.tileable));
    parallelFor(ctx, std::size_t(from.height), 8, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < from.width; ++x) {
                float* out = to.texel(x, y);
                std::fill_n(out, channels, 0.0f);
                for (int d = -reach; d <= reach; ++d) {
                    const int place = folded[std::size_t((columns ? x : y) + d + reach)];
                    const float* in = columns ? from.texel(place, y) : from.texel(x, place);
                    for (int c = 0; c < channels; ++c) out[c] += kernel[std::size_t(std::abs(d))] * in[c];
                }
            }
    });
}

// Means of blocks of `stride` texels; what is left over at the right and above is cut off.
SampleImage reduced(const SampleImage& image, int stride, int width, int height) {
    SampleImage out{width, height, image.channels, image.tileable, {}};
    out.values.assign(out.texels() * std::size_t(image.channels), 0);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float* sum = out.texel(x, y);
            int count = 0;
            for (int j = y * stride; j < std::min((y + 1) * stride, image.height); ++j)
                for (int i = x * stride; i < std::min((x + 1) * stride, image.width); ++i, ++count)
                    for (int c = 0; c < image.channels; ++c) sum[c] += image.texel(i, j)[c];
            for (int c = 0; c < image.channels; ++c) sum[c] /= float(count);
        }
    return out;
}

// The image as sites a step apart see it, a texel for each node: smoothed over 0.4 steps, of which the mean
// over a node's block is a part. Steps of a texel see it as it is.
SampleImage seenBy(const SampleLevel& level, const SampleImage& image, const RunContext& ctx) {
    if (level.step <= 1.3) return image;
    const double wanted = 0.4 * level.step / double(level.stride);
    const double had = level.stride > 1 ? 1.0 / 12 : 0;
    return smoothed(level.stride > 1 ? reduced(image, level.stride, level.width, level.height) : image,
                    std::sqrt(std::max(0.0, wanted * wanted - had)), ctx);
}

// Nodes of which all texels within `reach` nodes are valid; with a reach below 0 those that have any.
std::vector<char> usableNodes(const SampleImage& image, const SampleLevel& level, int reach) {
    // Sums over rectangles from the lower left corner, of texels that are not valid.
    const std::size_t columns = std::size_t(image.width) + 1;
    std::vector<std::uint32_t> bad(columns * (std::size_t(image.height) + 1), 0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::size_t at = (std::size_t(y) + 1) * columns + std::size_t(x) + 1;
            bad[at] = bad[at - 1] + bad[at - columns] - bad[at - columns - 1] +
                      (image.valid[std::size_t(y) * std::size_t(image.width) + std::size_t(x)] == 0);
        }
    std::vector<char> usable;
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const int around = std::max(0, reach);
            const int lowX = std::max(0, (x - around) * level.stride),
                      lowY = std::max(0, (y - around) * level.stride),
                      highX = std::min(image.width, (x + around + 1) * level.stride),
                      highY = std::min(image.height, (y + around + 1) * level.stride);
            const auto sum = [&](int i, int j) { return bad[std::size_t(j) * columns + std::size_t(i)]; };
            const std::uint32_t count =
                sum(highX, highY) + sum(lowX, lowY) - sum(lowX, highY) - sum(highX, lowY);
            usable.push_back(count <
                             (reach < 0 ? std::uint32_t((highX - lowX) * (highY - lowY)) : std::uint32_t(1)));
        }
    return usable;
}

// The margin beside texels that are not valid is as wide as that at the border, less where nothing would be
// left.
void findUsable(const SampleImage& image, SampleLevel& level, int margin) {
    if (image.valid.empty()) return;
    for (int reach = margin; reach >= -1; --reach) {
        level.usable = usableNodes(image, level, reach);
        for (std::int32_t node = 0; node < std::int32_t(level.usable.size()); ++node)
            if (level.isSource(level.centre(node))) return;
    }
    throw Error(ErrorCode::EmptyInput, "the sample has no valid texels");
}

// The nodes that appearances are described by: all, or those that are sources.
std::vector<std::int32_t> describedBy(const SampleLevel& level) {
    std::vector<std::int32_t> nodes;
    for (std::int32_t node = 0; node < std::int32_t(level.width * level.height); ++node)
        if (level.usable.empty() || level.usable[std::size_t(node)]) nodes.push_back(node);
    return nodes;
}

// The axes are centred on the described nodes, so their mean feature is zero.
double spreadOf(const SampleLevel& level, const std::vector<std::int32_t>& nodes) {
    double sum = 0;
    for (std::int32_t node : nodes)
        for (std::size_t d = 0; d < kFeature; ++d) {
            const float f = level.feature[std::size_t(node) * kFeature + d];
            sum += double(f) * double(f);
        }
    return sum / double(nodes.size());
}

}  // namespace

SampleImage smoothed(const SampleImage& image, double sigma, const RunContext& ctx) {
    if (!(sigma > 0.3)) return image;
    std::vector<float> kernel;
    double sum = 0;
    const int reach = int(std::ceil(2.5 * sigma));
    for (int d = 0; d <= reach; ++d) {
        kernel.push_back(float(exponential(-double(d * d) / (2 * sigma * sigma))));
        sum += double(kernel.back()) * (d == 0 ? 1 : 2);
    }
    for (float& k : kernel) k = float(double(k) / sum);
    SampleImage half = image, out = image;
    smoothAlong(image, half, kernel, true, ctx);
    smoothAlong(half, out, kernel, false, ctx);
    return out;
}

SampleLevel sampleLevel(const SampleImage& image, double step, std::size_t similar, const RunContext& ctx) {
    if (image.texels() == 0 || image.channels < 1)
        throw Error(ErrorCode::EmptyInput, "the sample has no texels");
    SampleLevel level;
    level.step = step;
    level.stride = std::max(1, int(step / 2));
    level.width = std::max(1, image.width / level.stride);
    level.height = std::max(1, image.height / level.stride);
    level.tileable = image.tileable;
    const int nodesInStep = int(std::ceil(step / double(level.stride)));
    if (!image.tileable) level.margin = std::min({nodesInStep, level.width / 4, level.height / 4});
    findUsable(image, level, nodesInStep);
    const SampleImage seen = seenBy(level, image, ctx);
    level.channels = std::size_t(image.channels);
    level.rank = ranksOf(seen);
    const std::vector<std::int32_t> described = describedBy(level);
    const std::size_t nodes = std::size_t(level.width) * std::size_t(level.height);
    const Windows windows(seen, level);
    level.appearance =
        projectAll(axesOf(described, windows.length(), kAppearance, windows), nodes, windows, ctx);
    const auto taps = [&level](std::int32_t node, float* out) { tapsAround(level, node, out); };
    level.taps = axesOf(described, 4 * kAppearance, kFeature, taps);
    level.feature = projectAll(level.taps, nodes, taps, ctx);
    level.spread = spreadOf(level, described);
    if (similar > 0) findSimilarNodes(level, similar, ctx);
    return level;
}

}  // namespace vdbsynth
