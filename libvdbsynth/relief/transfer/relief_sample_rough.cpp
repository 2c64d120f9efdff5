// Which part of a sample has relief.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/relief/transfer/relief_sample_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kDecile = 0.9;

// Sums over rectangles from the lower left corner.
class Sums {
public:
    template <typename Value>
    Sums(int width, int height, const Value& value) : mWidth(width), mHeight(height) {
        mSum.assign(std::size_t(width + 1) * std::size_t(height + 1), 0);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                mSum[at(x + 1, y + 1)] =
                    mSum[at(x, y + 1)] + mSum[at(x + 1, y)] - mSum[at(x, y)] + value(x, y);
    }

    /// Within `reach` along both axes.
    double around(int x, int y, int reach) const {
        const int lowX = std::max(0, x - reach), lowY = std::max(0, y - reach),
                  highX = std::min(mWidth, x + reach + 1), highY = std::min(mHeight, y + reach + 1);
        return mSum[at(highX, highY)] + mSum[at(lowX, lowY)] - mSum[at(lowX, highY)] - mSum[at(highX, lowY)];
    }

private:
    std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(mWidth + 1) + std::size_t(x); }

    int mWidth, mHeight;
    std::vector<double> mSum;
};

}  // namespace

void leavePlainOut(ReliefSample& sample, double share, double radius, const RunContext& ctx) {
    if (!(share > 0)) return;
    SampleImage& image = sample.image;
    const auto number = [&](int x, int y) {
        return std::size_t(y) * std::size_t(image.width) + std::size_t(x);
    };
    const Sums squares(image.width, image.height, [&](int x, int y) {
        const double h = double(image.values[number(x, y) * std::size_t(image.channels)]);
        return sample.known[number(x, y)] ? h * h : 0;
    });
    const Sums counts(image.width, image.height,
                      [&](int x, int y) { return sample.known[number(x, y)] ? 1 : 0; });
    const int reach = std::max(2, int(std::lround(radius)));
    std::vector<float> roughness(image.texels(), 0);
    parallelFor(ctx, std::size_t(image.height), 16, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y)
            for (int x = 0; x < image.width; ++x)
                roughness[number(x, y)] = float(std::sqrt(std::max(0.0, squares.around(x, y, reach)) /
                                                          std::max(1.0, counts.around(x, y, reach))));
    });
    std::vector<float> sorted;
    for (std::size_t i = 0; i < roughness.size(); ++i)
        if (image.valid[i]) sorted.push_back(roughness[i]);
    if (sorted.empty()) return;
    const auto decile = sorted.begin() + std::ptrdiff_t(kDecile * double(sorted.size() - 1));
    std::nth_element(sorted.begin(), decile, sorted.end());
    const float least = float(share) * *decile;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < roughness.size(); ++i) {
        if (!image.valid[i]) continue;
        image.valid[i] = roughness[i] >= least;
        kept += std::size_t(image.valid[i]);
    }
    sample.rough = double(kept) / double(sorted.size());
}

}  // namespace vdbsynth
