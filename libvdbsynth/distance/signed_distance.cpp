#include "libvdbsynth/distance/signed_distance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace vdbsynth {
namespace {

constexpr float kKept = 0.2f;    // [voxels] by which a distance may be beside the mesh's and stay as it is
constexpr float kUneven = 0.3f;  // by which a gradient's length may be off 1 where distances stay

// True if the field is one of distances around a sample: its gradient, central or upwind, is about 1 long.
// `value` points into a padded brick.
bool isDistance(const float* value, const std::ptrdiff_t (&stride)[3]) {
    const float sign = *value < 0 ? -1.f : 1.f;
    float central = 0, upwind = 0;
    for (const std::ptrdiff_t step : stride) {
        const float across = (value[step] - value[-step]) / 2;
        const float drop = std::max({0.f, sign * (*value - value[-step]), sign * (*value - value[step])});
        central += across * across;
        upwind += drop * drop;
    }
    return std::min(std::abs(std::sqrt(central) - 1), std::abs(std::sqrt(upwind) - 1)) < kUneven;
}

}  // namespace

BrickField withSigns(const OffsetField& distance, const OffsetField& sign, const Index3& size,
                     const RunContext& ctx) {
    return BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
        float signs[BrickField::kSamples];
        distance.field.readBox(brick.min + distance.offset, brick.size(), samples);
        sign.field.readBox(brick.min + sign.offset, brick.size(), signs);
        for (int i = 0; i < BrickField::kSamples; ++i) samples[i] = signs[i] < 0 ? -samples[i] : samples[i];
    });
}

BrickField keepingDistances(const OffsetField& toMesh, const OffsetField& own, const Index3& size, float band,
                            const RunContext& ctx) {
    return BrickField::generate(IndexBox::fromSize(size), ctx, [&](const IndexBox& brick, float* samples) {
        constexpr int kPadded = BrickField::kSide + 2;
        constexpr std::ptrdiff_t kStride[3] = {kPadded * kPadded, kPadded, 1};
        toMesh.field.readBox(brick.min + toMesh.offset, brick.size(), samples);
        float constant = 0;
        const Index3 first = brick.min + own.offset;
        if (own.field.constantIn({first, first + brick.size() - Index3{1, 1, 1}}, constant) &&
            own.field.box().contains(first) && std::abs(constant) >= band - 1) {
            if (constant < 0)
                std::transform(samples, samples + BrickField::kSamples, samples, std::negate<>());
            return;
        }
        float padded[kPadded * kPadded * kPadded];
        own.field.readBox(brick.min + own.offset - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        for (int x = 1; x <= BrickField::kSide; ++x)
            for (int y = 1; y <= BrickField::kSide; ++y)
                for (int z = 1; z <= BrickField::kSide; ++z, ++samples) {
                    const float* value = padded + (x * kPadded + y) * kPadded + z;
                    const float length = std::abs(*value), off = length - *samples;
                    if (std::abs(off) < 2 * kKept && length < band - 1 && isDistance(value, kStride))
                        *samples +=
                            std::abs(off) <= kKept ? off : std::copysign(2 * kKept - std::abs(off), off);
                    if (*value < 0) *samples = -*samples;
                }
    });
}

}  // namespace vdbsynth
