#include "libvdbsynth/distance/normalize_band.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vdbsynth {
namespace {

// A value over the length of its gradient towards the zero level, by the upwind differences of the eikonal
// equation [rouy1992]: those to the neighbours that are nearer to it. At most one voxel more than the nearest
// neighbour's, as a distance is. `value` points into an array of these strides.
float normalizedValue(const float* value, const std::ptrdiff_t (&stride)[3]) {
    const float sign = *value < 0 ? -1.f : 1.f;
    float squared = 0, nearest = std::abs(*value);
    for (std::ptrdiff_t step : stride) {
        const float near = std::max(0.f, std::min(sign * value[-step], sign * value[step]));
        const float drop = std::max({0.f, sign * (*value - value[-step]), sign * (*value - value[step])});
        nearest = std::min(nearest, near);
        squared += drop * drop;
    }
    return sign * std::min(std::abs(*value) / std::clamp(std::sqrt(squared), 0.25f, 4.f), nearest + 1);
}

// The most that a distance can be beside its six neighbours: a voxel more than one of the same side, a voxel
// beside the other side. Holds every distance; a seam between two copies may break it.
float longestBeside(const float* value, const std::ptrdiff_t (&stride)[3]) {
    float longest = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        for (const std::ptrdiff_t step : {-stride[axis], stride[axis]}) {
            const float other = value[step];
            longest = std::min(longest, (other < 0) == (*value < 0) ? std::abs(other) + 1 : 1.f);
        }
    return longest;
}

// A field whose every sample is made anew from itself and the six around it.
template <typename Change>
BrickField changedLocally(const BrickField& field, const RunContext& ctx, const Change& change) {
    return BrickField::generate(field.box(), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int kPadded = BrickField::kSide + 2;
        constexpr std::ptrdiff_t kStride[3] = {kPadded * kPadded, kPadded, 1};
        float padded[kPadded * kPadded * kPadded];
        field.readBox(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        for (int x = 1; x <= BrickField::kSide; ++x)
            for (int y = 1; y <= BrickField::kSide; ++y)
                for (int z = 1; z <= BrickField::kSide; ++z)
                    *samples++ = change(padded + (x * kPadded + y) * kPadded + z, kStride);
    });
}

// Each value over the length of its gradient: a distance to first order, exact where the field is one.
BrickField normalized(const BrickField& field, float limit, const RunContext& ctx) {
    return changedLocally(field, ctx, [limit](const float* value, const std::ptrdiff_t(&stride)[3]) {
        return std::abs(*value) >= limit ? *value : std::clamp(normalizedValue(value, stride), -limit, limit);
    });
}

// No value longer than its neighbours allow, so that every voxel beside the surface has all of its neighbours
// in the band.
BrickField shortened(const BrickField& field, float limit, const RunContext& ctx) {
    return changedLocally(field, ctx, [limit](const float* value, const std::ptrdiff_t(&stride)[3]) {
        const float most = std::min(limit, longestBeside(value, stride));
        return std::clamp(*value, -most, most);
    });
}

}  // namespace

BrickField normalizeBand(BrickField field, float limit, const RunContext& ctx) {
    for (int pass = 0; pass < 2; ++pass) field = normalized(field, limit, ctx);
    return shortened(field, limit, ctx);
}

}  // namespace vdbsynth
