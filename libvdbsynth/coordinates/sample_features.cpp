#include "libvdbsynth/coordinates/sample_features.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/search/feature_index.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

constexpr int kWindow = 2;                // places on each side of the middle
constexpr std::size_t kFitted = 4096;     // windows from which principal axes are found
constexpr std::size_t kSearched = 16384;  // nodes whose similar nodes are searched
constexpr double kApart = 0.05;           // share of the sample's side between similar nodes
constexpr float kInexact = 1;             // epsilon of the search for similar nodes

// Writes a node's vector. Called from many threads.
using VectorOf = std::function<void(std::int32_t node, float* out)>;

// The `count` principal axes of the vectors of at most kFitted nodes, evenly chosen; beyond the vectors'
// length they are zero.
PrincipalAxes axesOf(std::size_t nodes, std::size_t length, std::size_t count, const VectorOf& vectorOf) {
    const std::size_t fitted = std::min(nodes, kFitted);
    std::vector<float> some(fitted * length);
    for (std::size_t i = 0; i < fitted; ++i)
        vectorOf(std::int32_t(i * nodes / fitted), some.data() + i * length);
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

// Distance between two nodes along the longer axis, around the border where the sample is tileable. [nodes]
int apart(const SampleLevel& level, std::int32_t a, std::int32_t b) {
    int dx = std::abs(a % level.width - b % level.width), dy = std::abs(a / level.width - b / level.width);
    if (level.tileable) {
        dx = std::min(dx, level.width - dx);
        dy = std::min(dy, level.height - dy);
    }
    return std::max(dx, dy);
}

// Finds the similar nodes of every `sparse`-th node along both axes; the others take theirs from the nearest
// of these, moved along.
class SimilarNodes {
public:
    SimilarNodes(SampleLevel& level, std::size_t count) : mLevel(level), mCount(count) {
        std::size_t nodes = std::size_t(level.width) * std::size_t(level.height);
        while (nodes / std::size_t(mSparse * mSparse) > kSearched) ++mSparse;
        const int longer = std::max(level.width, level.height);
        mApart = std::max(int(kApart * double(longer)), 1 + int(level.step / double(level.stride)));
    }

    void find(const RunContext& ctx) {
        level().similar.assign(std::size_t(mLevel.width) * std::size_t(mLevel.height) * mCount, -1);
        std::vector<std::int32_t> nodes = sources();
        if (nodes.size() < 2) return;
        std::vector<float> rows;
        for (std::int32_t node : nodes)
            rows.insert(rows.end(), mLevel.feature.data() + std::size_t(node) * kFeature,
                        mLevel.feature.data() + std::size_t(node + 1) * kFeature);
        const FeatureIndex index(std::move(rows), kFeature);
        Stage stage(ctx, "similar texels", nodes.size());
        parallelFor(ctx, nodes.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) findOne(index, nodes, std::int32_t(i));
        });
        spreadToAll(ctx);
    }

private:
    SampleLevel& level() { return mLevel; }
    std::int32_t* slot(std::int32_t node) { return mLevel.similar.data() + std::size_t(node) * mCount; }

    std::vector<std::int32_t> sources() const {
        std::vector<std::int32_t> nodes;
        for (int y = mLevel.margin; y < mLevel.height - mLevel.margin; y += mSparse)
            for (int x = mLevel.margin; x < mLevel.width - mLevel.margin; x += mSparse)
                nodes.push_back(std::int32_t(y) * mLevel.width + x);
        return nodes;
    }

    void findOne(const FeatureIndex& index, const std::vector<std::int32_t>& nodes, std::int32_t i) {
        const std::int32_t own = nodes[std::size_t(i)];
        const auto far = [&](std::int32_t row) {
            return apart(mLevel, own, nodes[std::size_t(row)]) >= mApart;
        };
        // Several times too many, of which those far from each other are kept.
        const std::vector<FeatureMatch> matches = index.nearestSome(index.row(i), 4 * mCount, far, kInexact);
        std::size_t found = 0;
        for (const FeatureMatch& match : matches) {
            const std::int32_t node = nodes[std::size_t(match.row)];
            bool fresh = true;
            for (std::size_t k = 0; k < found; ++k) fresh &= apart(mLevel, slot(own)[k], node) >= mApart;
            if (fresh) slot(own)[found++] = node;
            if (found == mCount) break;
        }
    }

    void spreadToAll(const RunContext& ctx) {
        if (mSparse == 1) return;
        parallelFor(ctx, std::size_t(mLevel.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < mLevel.width; ++x) spreadTo(x, y);
        });
    }

    // The searched node that shares a node's cell, along one axis.
    int searchedBefore(int at, int size) const {
        const int last = std::max(mLevel.margin, size - mLevel.margin - 1);
        const int inside = std::clamp(at, mLevel.margin, last);
        return mLevel.margin + (inside - mLevel.margin) / mSparse * mSparse;
    }

    void spreadTo(int x, int y) {
        const int fromX = searchedBefore(x, mLevel.width), fromY = searchedBefore(y, mLevel.height);
        if (fromX == x && fromY == y) return;
        const std::int32_t from = std::int32_t(fromY) * mLevel.width + fromX;
        const std::int32_t own = std::int32_t(y) * mLevel.width + x;
        for (std::size_t k = 0; k < mCount; ++k) {
            const std::int32_t like = slot(from)[k];
            if (like < 0) continue;
            const int toX = like % mLevel.width + x - fromX, toY = like / mLevel.width + y - fromY;
            if (toX < 0 || toY < 0 || toX >= mLevel.width || toY >= mLevel.height) continue;
            slot(own)[k] = std::int32_t(toY) * mLevel.width + toX;
        }
    }

    SampleLevel& mLevel;
    std::size_t mCount;
    int mSparse = 1, mApart = 1;
};

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
    const SampleImage seen = seenBy(level, image, ctx);
    level.channels = std::size_t(image.channels);
    level.rank = ranksOf(seen);
    const std::size_t nodes = std::size_t(level.width) * std::size_t(level.height);
    const Windows windows(seen, level);
    level.appearance = projectAll(axesOf(nodes, windows.length(), kAppearance, windows), nodes, windows, ctx);
    const auto taps = [&level](std::int32_t node, float* out) { tapsAround(level, node, out); };
    level.taps = axesOf(nodes, 4 * kAppearance, kFeature, taps);
    level.feature = projectAll(level.taps, nodes, taps, ctx);
    // The axes are centred, so the mean feature is zero.
    for (float f : level.feature) level.spread += double(f) * double(f);
    level.spread /= double(level.feature.size() / kFeature);
    level.similarCount = similar;
    if (similar > 0) SimilarNodes(level, similar).find(ctx);
    return level;
}

}  // namespace vdbsynth
