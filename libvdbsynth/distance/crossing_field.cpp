#include "libvdbsynth/distance/crossing_field.h"

#include <algorithm>
#include <cstddef>

namespace vdbsynth {

BrickField crossingField(const IndexBox& box, float limit, const RunContext& ctx, const BoxFill& fill) {
    constexpr int kSide = BrickField::kSide, kPadded = kSide + 2;
    return BrickField::generate(box, ctx, [&](const IndexBox& brick, float* samples) {
        float padded[kPadded * kPadded * kPadded];
        fill(brick.min - Index3{1, 1, 1}, {kPadded, kPadded, kPadded}, padded);
        const bool inside = padded[0] < 0;
        if (std::all_of(std::begin(padded), std::end(padded), [&](float v) { return (v < 0) == inside; })) {
            std::fill_n(samples, BrickField::kSamples, inside ? -limit : limit);
            return;
        }
        for (int x = 1; x <= kSide; ++x)
            for (int y = 1; y <= kSide; ++y) {
                const float* row = padded + (x * kPadded + y) * kPadded + 1;
                samples = std::copy(row, row + kSide, samples);
            }
    });
}

}  // namespace vdbsynth
