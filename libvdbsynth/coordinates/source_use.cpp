#include "libvdbsynth/coordinates/source_use.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kSitesInPart = 24;  // about, so that counts mean something
constexpr int kMostParts = 12;       // along a side
constexpr double kFineHistogram =
    0.9;                           // share of the weight of values that ends where sites are a texel apart
constexpr double kFewSites = 100;  // whose counts weigh half
constexpr double kMostUse = 4;     // of what is expected

// use / expected - 1, limited.
double over(double use, double expected) {
    return (expected > 0 ? std::min(use / expected, kMostUse) : kMostUse) - 1;
}

}  // namespace

SourceUse::SourceUse(const CoordinateLevel& level, double uniformity, double histogram)
    : mUniformity(uniformity), mHistogram(histogram) {
    std::vector<double> sites(level.samples.size());
    for (std::int32_t label : level.label) sites[std::size_t(label)] += 1;
    for (std::size_t l = 0; l < level.samples.size(); ++l) {
        const SampleLevel& from = level.samples[l];
        const int parts = std::clamp(int(std::sqrt(sites[l] / kSitesInPart)), 1, kMostParts);
        const int columns = std::min(parts, from.width), rows = std::min(parts, from.height);
        const std::size_t nodes = std::size_t(from.width) * std::size_t(from.height);
        Sample sample;
        sample.part.resize(nodes);
        sample.expectedInPart.assign(std::size_t(columns * rows), 0);
        sample.expectedOfRank.assign(from.channels * kRanks, 0);
        double sources = 0;
        for (std::size_t node = 0; node < nodes; ++node) {
            const int x = int(node) % from.width, y = int(node) / from.width;
            sample.part[node] = std::uint32_t(y * rows / from.height * columns + x * columns / from.width);
            if (!from.isSource(from.centre(std::int32_t(node)))) continue;
            sources += 1;
            sample.expectedInPart[sample.part[node]] += 1;
            for (std::size_t c = 0; c < from.channels; ++c)
                sample.expectedOfRank[c * kRanks + from.rank[node * from.channels + c]] += 1;
        }
        for (double& share : sample.expectedInPart) share /= std::max(sources, 1.0);
        for (double& share : sample.expectedOfRank) share /= std::max(sources, 1.0);
        sample.cost.assign(nodes, 0);
        mSamples.push_back(std::move(sample));
    }
}

void SourceUse::count(const CoordinateLevel& level) {
    if (mUniformity == 0 && mHistogram == 0) return;
    for (Sample& sample : mSamples) sample.usedNode.assign(sample.part.size(), 0);
    for (std::size_t i = 0; i < level.coordinate.size(); ++i) {
        const std::size_t l = std::size_t(level.label[i]);
        ++mSamples[l].usedNode[std::size_t(level.samples[l].node(level.coordinate[i]))];
    }
    for (std::size_t l = 0; l < mSamples.size(); ++l) weigh(level.samples[l], mSamples[l]);
}

void SourceUse::weigh(const SampleLevel& level, Sample& sample) const {
    const std::size_t channels = level.channels;
    std::vector<double> inPart(sample.expectedInPart.size()), ofRank(channels * kRanks);
    double sites = 0;
    for (std::size_t node = 0; node < sample.usedNode.size(); ++node) {
        const double used = double(sample.usedNode[node]);
        if (used == 0) continue;
        sites += used;
        inPart[sample.part[node]] += used;
        for (std::size_t c = 0; c < channels; ++c)
            ofRank[c * kRanks + level.rank[node * channels + c]] += used;
    }
    // Fine levels keep what coarse ones balanced; few sites, or a target smaller than the sample, say little.
    const double texels = double(level.width) * double(level.height) * double(level.stride * level.stride);
    const double area = sites * level.step * level.step / texels;
    const double trust = level.spread * sites / (sites + kFewSites) * area / (area + 1);
    const double fine = 1 / std::max(1.0, level.step);
    const double weight = mUniformity * trust * (1 - fine);
    const double histogramWeight = mHistogram * trust * (1 - kFineHistogram * fine);
    for (std::size_t p = 0; p < inPart.size(); ++p)
        inPart[p] = weight * over(inPart[p], sample.expectedInPart[p] * sites);
    for (std::size_t r = 0; r < ofRank.size(); ++r)
        ofRank[r] = histogramWeight * over(ofRank[r], sample.expectedOfRank[r] * sites) / double(channels);
    for (std::size_t node = 0; node < sample.cost.size(); ++node) {
        double cost = inPart[sample.part[node]];
        for (std::size_t c = 0; c < channels; ++c)
            cost += ofRank[c * kRanks + level.rank[node * channels + c]];
        sample.cost[node] = float(cost);
    }
}

}  // namespace vdbsynth
