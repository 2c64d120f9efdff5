#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/texture/histogram_blend.h"
#include "libvdbsynth/texture/point_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kSide = 9;             // [places] of a window
constexpr std::size_t kTried = 256;  // windows
constexpr std::size_t kMost = 4096;  // windows of the sample that each is compared with
constexpr std::uint32_t kDraw = 0x7a02;

// Windows of a sample at places `apart` texels from each other.
class Windows {
public:
    Windows(const SampleImage& sample, int apart)
        : mSample(sample), mApart(apart), mReach((kSide - 1) * apart) {
        const std::size_t places = std::size_t(std::max(0, sample.width - mReach)) *
                                   std::size_t(std::max(0, sample.height - mReach));
        const std::size_t step = std::max<std::size_t>(1, (places + kMost - 1) / kMost);
        for (std::size_t i = 0; i < places; i += step)
            mCorner.push_back(
                {int(i % std::size_t(sample.width - mReach)), int(i / std::size_t(sample.width - mReach))});
        for (const Corner& corner : mCorner) read(corner, mValues);
    }

    bool tooFew() const {  // at least windows with room for one that does not overlap
        return mSample.width < 2 * mReach + 2 || mSample.height < 2 * mReach + 2;
    }
    std::size_t length() const { return std::size_t(kSide * kSide * mSample.channels); }
    std::size_t count() const { return mCorner.size(); }
    const float* window(std::size_t i) const { return mValues.data() + i * length(); }

    std::vector<float> mixed(const HistogramBlend& blend, Random& random) const {
        BlendPart parts[2];
        for (BlendPart& part : parts) {
            part.at = {float(random.below(std::uint32_t(mSample.width - mReach))) + 0.5f,
                       float(random.below(std::uint32_t(mSample.height - mReach))) + 0.5f};
            part.weight = 0.5f;
        }
        std::vector<float> out(length());
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec2f by{float(x * mApart), float(y * mApart)};
                const BlendPart moved[2] = {{parts[0].at + by, 0.5f}, {parts[1].at + by, 0.5f}};
                blend.mix(moved, 2, out.data() + (y * kSide + x) * mSample.channels);
            }
        return out;
    }

    // The distance to the nearest window, of those that do not overlap window `except`.
    double nearest(const float* values, std::size_t except) const {
        float best = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < count(); ++i) {
            if (except < count() && overlap(mCorner[i], mCorner[except])) continue;
            const float* other = window(i);
            float sum = 0;
            for (std::size_t k = 0; k < length() && sum < best; ++k)
                sum += (values[k] - other[k]) * (values[k] - other[k]);
            best = std::min(best, sum);
        }
        return std::isfinite(best) ? std::sqrt(double(best)) : 0;
    }

private:
    struct Corner {
        int x, y;
    };

    void read(const Corner& corner, std::vector<float>& out) const {
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const float* texel = mSample.texel(corner.x + x * mApart, corner.y + y * mApart);
                out.insert(out.end(), texel, texel + mSample.channels);
            }
    }
    bool overlap(const Corner& a, const Corner& b) const {
        return std::abs(a.x - b.x) <= mReach && std::abs(a.y - b.y) <= mReach;
    }

    const SampleImage& mSample;
    int mApart, mReach;
    std::vector<Corner> mCorner;
    std::vector<float> mValues;
};

// Of one size of windows.
double lossAt(const SampleImage& sample, const HistogramBlend& blend, int apart, const RunContext& ctx) {
    const Windows windows(sample, apart);
    if (windows.tooFew()) return 1;
    std::vector<double> mixed(kTried), own(kTried);
    parallelFor(ctx, kTried, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Random random(0, i, kDraw);
            const std::size_t number = random.below(std::uint32_t(windows.count()));
            own[i] = windows.nearest(windows.window(number), number);
            mixed[i] = windows.nearest(windows.mixed(blend, random).data(), windows.count());
        }
    });
    double ofMixed = 0, ofOwn = 0;
    for (std::size_t i = 0; i < kTried; ++i) {
        ofMixed += mixed[i];
        ofOwn += own[i];
    }
    return ofOwn > 0 ? ofMixed / ofOwn : ofMixed > 0 ? 1e3 : 1;
}

}  // namespace

double blendLoss(const SampleImage& sample, const RunContext& ctx) {
    requireSample(sample);
    const HistogramBlend blend(sample, ctx);
    return std::max(lossAt(sample, blend, 1, ctx), lossAt(sample, blend, 3, ctx));
}

}  // namespace vdbsynth
