#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/texture/histogram_blend.h"
#include "libvdbsynth/texture/point_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kSide = 9;             // [places] of a window
constexpr std::size_t kTried = 256;  // windows
constexpr std::size_t kMost = 4096;  // windows of the sample that each is compared with
constexpr std::uint32_t kDraw = 0x7a02;
constexpr double kLost = 1000;  // where a mix has nothing like it though all of the sample has

struct Corner {
    int x, y;
};

// In lanes, so that a processor can add several at once; given up above `most` after some values.
float squaredDistance(const float* a, const float* b, std::size_t count, float most) {
    constexpr std::size_t kLanes = 8, kBlock = 32;
    std::array<float, kLanes> lanes{};
    float sum = 0;
    std::size_t k = 0;
    for (; k + kBlock <= count && sum < most; k += kBlock) {
        for (std::size_t j = 0; j < kBlock; j += kLanes)
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const float d = a[k + j + lane] - b[k + j + lane];
                lanes[lane] += d * d;
            }
        sum = 0;
        for (float lane : lanes) sum += lane;
    }
    if (sum >= most) return sum;
    for (; k < count; ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

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

    Corner draw(Random& random) const {
        const std::uint32_t x = random.below(std::uint32_t(mSample.width - mReach));
        return {int(x), int(random.below(std::uint32_t(mSample.height - mReach)))};
    }

    std::vector<float> at(const Corner& corner) const {
        std::vector<float> out;
        read(corner, out);
        return out;
    }

    std::vector<float> mixed(const HistogramBlend& blend, const Corner& a, const Corner& b) const {
        std::vector<float> out(length());
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const Vec2f by{float(x * mApart) + 0.5f, float(y * mApart) + 0.5f};
                const BlendPart parts[2] = {{Vec2f{float(a.x), float(a.y)} + by, 0.5f},
                                            {Vec2f{float(b.x), float(b.y)} + by, 0.5f}};
                blend.mix(parts, 2, out.data() + (y * kSide + x) * mSample.channels);
            }
        return out;
    }

    // The distance to the nearest window that overlaps neither of two; negative if there is none.
    double nearest(const std::vector<float>& values, const Corner& a, const Corner& b) const {
        float best = std::numeric_limits<float>::infinity();
        for (std::size_t i = 0; i < count(); ++i) {
            if (overlap(mCorner[i], a) || overlap(mCorner[i], b)) continue;
            best = std::min(best, squaredDistance(values.data(), window(i), length(), best));
        }
        return std::isfinite(best) ? std::sqrt(double(best)) : -1;
    }

private:
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
            const Corner a = windows.draw(random), b = windows.draw(random);
            own[i] = windows.nearest(windows.at(a), a, b);
            mixed[i] = windows.nearest(windows.mixed(blend, a, b), a, b);
        }
    });
    double ofMixed = 0, ofOwn = 0;
    for (std::size_t i = 0; i < kTried; ++i) {
        if (own[i] < 0) continue;
        ofMixed += mixed[i];
        ofOwn += own[i];
    }
    return ofOwn > 0 ? ofMixed / ofOwn : ofMixed > 0 ? kLost : 1;
}

}  // namespace

double blendLoss(const SampleImage& sample, const RunContext& ctx) {
    requireSample(sample);
    const HistogramBlend blend(sample, ctx);
    return std::max(lossAt(sample, blend, 1, ctx), lossAt(sample, blend, 3, ctx));
}

}  // namespace vdbsynth
