#include "libvdbsynth/analogy/analogy_features.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kDepthWeight = 1;  // a voxel of depth weighs as much as a sample's change from empty to full

// A column of the cube: its middle and its direction.
struct Column {
    Vec3f foot, along;
};

// The part of a field around columns, copied once, so that a hundred interpolations
// need not look up its bricks.
class Window {
public:
    Window(const BrickField& field, const std::vector<Column>& columns, float half) {
        Vec3f low = columns.front().foot, high = low;
        for (const Column& column : columns)
            for (int axis = 0; axis < 3; ++axis) {
                const float reach = std::abs(column.along[axis]) * half;
                low[axis] = std::min(low[axis], column.foot[axis] - reach);
                high[axis] = std::max(high[axis], column.foot[axis] + reach);
            }
        Index3 size;
        for (int axis = 0; axis < 3; ++axis) {
            // Rounding may move a sample slightly beyond; the extra voxel at the far side is then never read.
            mCorner[axis] = int(std::floor(low[axis] - 1e-3f));
            size[axis] = int(std::floor(high[axis] + 1e-3f)) - mCorner[axis] + 2;
        }
        mRow = size.z;
        mSlice = size.y * size.z;
        float value = 0;
        mConstant = field.constantIn({mCorner, mCorner + size - Index3{1, 1, 1}}, value);
        mValue = value;
        if (mConstant) return;
        mSamples.resize(std::size_t(size.x) * std::size_t(mSlice));
        field.readBox(mCorner, size, mSamples.data());
    }

    float at(const Vec3f& p) const {
        if (mConstant) return mValue;
        const float x = p.x - float(mCorner.x), y = p.y - float(mCorner.y), z = p.z - float(mCorner.z);
        const int ix = int(x), iy = int(y), iz = int(z);
        const float fx = x - float(ix), fy = y - float(iy), fz = z - float(iz);
        const float* v = mSamples.data() + ix * mSlice + iy * mRow + iz;
        const float *w = v + mRow, *u = v + mSlice, *t = u + mRow;
        const auto mix = [](float a, float b, float f) { return a + (b - a) * f; };
        const float low = mix(mix(v[0], v[1], fz), mix(w[0], w[1], fz), fy),
                    high = mix(mix(u[0], u[1], fz), mix(t[0], t[1], fz), fy);
        return mix(low, high, fx);
    }

private:
    int mRow = 0, mSlice = 0;
    Index3 mCorner;
    bool mConstant = false;
    float mValue = 0;
    std::vector<float>& mSamples = scratch();

    // A window is constructed for every voxel of every sweep.
    static std::vector<float>& scratch() {
        thread_local std::vector<float> samples;
        return samples;
    }
};

Column columnAt(const Vec3f& at, const Frame& frame, const Curvature& curvature, float t, float b) {
    const Vec3f flat = at + frame.t * t + frame.b * b;
    const float overT = curvature.tt * t + curvature.tb * b, overB = curvature.tb * t + curvature.bb * b;
    if (overT == 0 && overB == 0) return {flat, frame.n};
    const Vec3f along = frame.n + frame.t * overT + frame.b * overB;
    return {flat - frame.n * (0.5f * (overT * t + overB * b)), along * (1 / length(along))};
}

// Samples of the cube of steps along the frame's axes, up to lastAlong along t; t slowest, n fastest.
float* sampleCube(const BrickField& field, const Vec3f& at, const Frame& frame, const Curvature& curvature,
                  int half, int lastAlong, bool middleToo, float* out) {
    thread_local std::vector<Column> columns;
    columns.clear();
    for (int t = -half; t <= lastAlong; ++t)
        for (int b = -half; b <= half; ++b)
            columns.push_back(columnAt(at, frame, curvature, float(t), float(b)));
    const Window window(field, columns, float(half));
    const std::size_t middle = std::size_t(half * (2 * half + 1) + half);
    for (std::size_t c = 0; c < columns.size(); ++c)
        for (int n = -half; n <= half; ++n)
            if (middleToo || c != middle || n != 0)
                *out++ = window.at(columns[c].foot + columns[c].along * float(n));
    return out;
}

}  // namespace

void sampleMade(const FeatureShape& shape, const BrickField& textured, const Vec3f& at, const Frame& frame,
                const Curvature& curvature, float* out) {
    sampleCube(textured, at, frame, curvature, shape.half, shape.causal ? -1 : shape.half, false, out);
}

void sampleRest(const FeatureShape& shape, const FeatureFields& fields, const Vec3f& at, const Frame& frame,
                const Curvature& curvature, float* out) {
    out = sampleCube(*fields.plain, at, frame, curvature, shape.half, shape.half, true, out);
    if (!shape.coarse) return;
    const Vec3f coarse{at.x / 2 - 0.25f, at.y / 2 - 0.25f, at.z / 2 - 0.25f};
    // A step twice as large doubles the curvature.
    const Curvature wide{2 * curvature.tt, 2 * curvature.tb, 2 * curvature.bb};
    out = sampleCube(*fields.coarseTextured, coarse, frame, wide, shape.coarseHalf, shape.coarseHalf, true,
                     out);
    sampleCube(*fields.coarsePlain, coarse, frame, wide, shape.coarseHalf, shape.coarseHalf, true, out);
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

// Axes of one sample are contiguous, so that all coordinates are summed in parallel.
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
