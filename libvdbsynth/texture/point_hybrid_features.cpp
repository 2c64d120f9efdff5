#include "libvdbsynth/texture/point_hybrid.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kUncorrelated = 0.1;
constexpr int kPlaces = 16;  // of a window, along each axis

struct Moments {
    double mean = 0, deviation = 0;
};

Moments momentsOf(const SampleImage& sample, const SampleWindow& window, int channel) {
    double sum = 0, squares = 0;
    for (int y = window.y; y < window.y + window.height; ++y)
        for (int x = window.x; x < window.x + window.width; ++x) {
            const double v = double(sample.texel(x, y)[channel]);
            sum += v;
            squares += v * v;
        }
    const double n = double(window.width) * double(window.height), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean))};
}

// Mean product of deviations of texels (dx, dy) apart.
double covariance(const SampleImage& sample, const std::vector<Moments>& moments, int dx, int dy) {
    double sum = 0;
    for (int y = 0; y + dy < sample.height; ++y)
        for (int x = 0; x + dx < sample.width; ++x) {
            const float *a = sample.texel(x, y), *b = sample.texel(x + dx, y + dy);
            for (int c = 0; c < sample.channels; ++c) {
                const double mean = moments[std::size_t(c)].mean;
                sum += (double(a[c]) - mean) * (double(b[c]) - mean);
            }
        }
    return sum / (double(sample.width - dx) * double(sample.height - dy));
}

}  // namespace

double featureSize(const SampleImage& sample) {
    requireSample(sample);
    const int most = std::max(1, std::min(sample.width, sample.height) / 4);
    std::vector<Moments> moments;
    double variance = 0;
    for (int c = 0; c < sample.channels; ++c) {
        moments.push_back(momentsOf(sample, {0, 0, sample.width, sample.height}, c));
        variance += moments.back().deviation * moments.back().deviation;
    }
    if (!(variance > 0)) return 1;
    int first = 1;  // the first distance at which texels are not correlated
    for (; first < most; ++first) {
        const double along =
            0.5 * (covariance(sample, moments, first, 0) + covariance(sample, moments, 0, first));
        if (along < kUncorrelated * variance) break;
    }
    return double(first);
}

SampleWindow typicalWindow(const SampleImage& sample, int side) {
    SampleWindow best{0, 0, std::min(side, sample.width), std::min(side, sample.height)};
    const int roomX = sample.width - best.width, roomY = sample.height - best.height;
    const int placesX = std::min(kPlaces, roomX + 1), placesY = std::min(kPlaces, roomY + 1);
    const SampleWindow whole{0, 0, sample.width, sample.height};
    double least = -1;
    for (int j = 0; j < placesY; ++j)
        for (int i = 0; i < placesX; ++i) {
            SampleWindow window = best;
            window.x = placesX > 1 ? roomX * i / (placesX - 1) : 0;
            window.y = placesY > 1 ? roomY * j / (placesY - 1) : 0;
            double apart = 0;
            for (int c = 0; c < sample.channels; ++c) {
                const Moments a = momentsOf(sample, window, c), b = momentsOf(sample, whole, c);
                apart += (a.mean - b.mean) * (a.mean - b.mean) +
                         (a.deviation - b.deviation) * (a.deviation - b.deviation);
            }
            if (least >= 0 && apart >= least) continue;
            least = apart;
            best = window;
        }
    return best;
}

}  // namespace vdbsynth
