// Distances far from a surface: exact ones nearby, those to spread points beyond.
#include "libvdbsynth/distance/signed_distance.h"
#include "libvdbsynth/relief/base_surface_steps.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kSamples = BrickField::kSamples;
constexpr float kBlended = 1;  // [voxels] in which near distances pass over to far ones

}  // namespace

IndexBox latticeBox(const IndexBox& box, int step) {
    const Index3 size = box.size();
    return IndexBox::fromSize({(size.x - 2) / step + 2, (size.y - 2) / step + 2, (size.z - 2) / step + 2});
}

WideDistances wideDistances(const BrickField& field, float band, float reach, const RunContext& ctx) {
    WideDistances wide;
    wide.near = widenedDistances(field, band, 1, kNearReach, ctx).field;
    wide.far = widenedDistances(wide.near, kNearReach, kFarStep, reach, ctx);
    return wide;
}

BrickField joined(const WideDistances& wide, float reach, const RunContext& ctx) {
    const BrickField& near = wide.near;
    const BrickField far = refined(wide.far, near.box(), reach, ctx);
    return BrickField::generate(near.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float own[kSamples];
        far.readBox(brick.min, brick.size(), samples);
        near.readBox(brick.min, brick.size(), own);
        for (int i = 0; i < kSamples; ++i) {
            const float length = std::abs(own[i]), least = kNearReach - kBlended;
            const float share = std::clamp((length - least) / kBlended, 0.f, 1.f);
            const float both =
                std::min(reach, length + share * (std::max(std::abs(samples[i]), least) - length));
            samples[i] = own[i] < 0 ? -both : both;
        }
    });
}

SmoothField widenedDistances(const BrickField& field, float band, int step, float reach,
                             const RunContext& ctx) {
    const BrickField far = unsignedDistances(field, step, band, reach, ctx);
    if (step == 1)
        return {keepingDistances({far, {0, 0, 0}}, {field, {0, 0, 0}}, field.box().size(), band, ctx), 1};
    return {BrickField::generate(latticeBox(field.box(), step), ctx,
                                 [&](const IndexBox& brick, float* samples) {
                                     far.readBox(brick.min, brick.size(), samples);
                                     forEachVoxel(brick, [&](const Index3& p) {
                                         const float own = field.at(p * step);
                                         const float length =
                                             std::abs(own) < band - 1 ? std::abs(own) : *samples;
                                         *samples++ = own < 0 ? -length : length;
                                     });
                                 }),
            step};
}

}  // namespace vdbsynth
