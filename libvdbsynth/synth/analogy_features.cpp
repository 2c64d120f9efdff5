#include "libvdbsynth/synth/analogy_features.h"

#include "libvdbsynth/grid/field_sampling.h"

#include <algorithm>

namespace vdbsynth {
namespace {

constexpr float kDepthWeight = 1;  // of a voxel of depth beside a sample that differs from empty to full

// Samples of the box [low, high] of steps along the frame's axes; t slowest, n fastest.
float* sampleCube(const BrickField& field, const Vec3f& at, const Frame& frame, int half, int lastAlong,
                  float* out) {
    for (int t = -half; t <= lastAlong; ++t)
        for (int b = -half; b <= half; ++b) {
            const Vec3f row = at + frame.t * float(t) + frame.b * float(b);
            for (int n = -half; n <= half; ++n) *out++ = sampleTrilinear(field, row + frame.n * float(n));
        }
    return out;
}

}  // namespace

void sampleMade(const FeatureShape& shape, const BrickField& textured, const Vec3f& at, const Frame& frame,
                float* out) {
    float* end = sampleCube(textured, at, frame, shape.half, shape.causal ? -1 : shape.half, out);
    if (shape.causal) return;
    float* middle = out + (end - out) / 2;
    std::copy(middle + 1, end, middle);
}

void sampleRest(const FeatureShape& shape, const FeatureFields& fields, const Vec3f& at, const Frame& frame,
                float* out) {
    out = sampleCube(*fields.plain, at, frame, shape.half, shape.half, out);
    if (!shape.coarse) return;
    const Vec3f coarse{at.x / 2 - 0.25f, at.y / 2 - 0.25f, at.z / 2 - 0.25f};
    out = sampleCube(*fields.coarseTextured, coarse, frame, shape.coarseHalf, shape.coarseHalf, out);
    sampleCube(*fields.coarsePlain, coarse, frame, shape.coarseHalf, shape.coarseHalf, out);
}

ReducedFeatures::ReducedFeatures(const FeatureShape& shape, const PrincipalAxes& axes)
    : mMade(shape.made()),
      mLength(shape.size()),
      mCount(axes.count),
      mAxes(mLength * mCount),
      mMean(axes.mean) {
    for (std::size_t i = 0; i < mCount; ++i)
        for (std::size_t k = 0; k < mLength; ++k) mAxes[k * mCount + i] = axes.axes[i * mLength + k];
}

// Axes of one sample lie side by side, so that all coordinates grow at once.
void ReducedFeatures::add(std::size_t begin, std::size_t end, const float* samples, float* out) const {
    for (std::size_t k = begin; k < end; ++k) {
        const float value = samples[k - begin] - mMean[k];
        const float* axis = mAxes.data() + k * mCount;
        for (std::size_t i = 0; i < mCount; ++i) out[i] += value * axis[i];
    }
}

void ReducedFeatures::addMade(const float* made, const float* rest, float* out) const {
    std::copy(rest, rest + count(), out);
    add(0, mMade, made, out);
}

void ReducedFeatures::ofRest(const float* rest, float depth, float* out) const {
    std::fill(out, out + mCount, 0.f);
    add(mMade, mLength, rest, out);
    out[mCount] = kDepthWeight * depth;
}

}  // namespace vdbsynth
