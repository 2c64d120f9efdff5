#include "libvdbsynth/relief/relief_strength.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/distance/widen_band.h"
#include "libvdbsynth/relief/relief_layer.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

// The base with as much reach as the relief times its strength has.
BaseSurface withReach(const BaseSurface& base, float reach, const RunContext& ctx) {
    BaseSurface wide = base;
    wide.distance = widenBand({base.distance, base.distance.box(), base.reach}, reach, ctx);
    wide.scan = widenBand({base.scan, base.scan.box(), base.reach}, reach, ctx);
    wide.reach = reach;
    return wide;
}

constexpr float kExact = 0.1f;  // [voxels] by which base + relief may miss the scan

float mixed(float distance, float scan, float strength) {
    return (1 - strength) * distance + strength * scan;
}

float displaced(const ReliefPoint& relief, float distance, float scan, float strength) {
    // A height that puts a place on the wrong side of the scan is none.
    const bool wrong = (distance < relief.height) != (scan < 0) && std::abs(scan) > kExact;
    if (relief.folds || wrong) return mixed(distance, scan, strength);
    const float steep = std::max(0.f, 1 / (relief.slope * relief.slope) - 1) * strength * strength;
    return (distance - strength * relief.height) / std::sqrt(1 + steep);
}

}  // namespace

BrickField reliefSurface(const BaseSurface& base, double strength, const RunContext& ctx) {
    requireOption(std::abs(strength) <= 100, "strength", roundedText(strength, 6), "from -100 to 100");
    if (strength == 0) return base.distance;
    const float s = float(strength), most = std::max(1.f, std::abs(s));
    const BaseSurface wide = most > 1 ? withReach(base, most * base.reach, ctx) : base;
    const ReliefLayer layer = reliefLayer(wide, wide.reach, ctx);
    const float limit = wide.reach;
    return BrickField::generate(base.distance.box(), ctx, [&](const IndexBox& brick, float* samples) {
        float scan[BrickField::kSamples];
        wide.distance.readBox(brick.min, brick.size(), samples);
        wide.scan.readBox(brick.min, brick.size(), scan);
        const float* own = scan;
        forEachVoxel(brick, [&](const Index3& p) {
            const std::int32_t i = layer.voxels.find(p);
            const float value =
                i < 0 ? mixed(*samples, *own, s) : displaced(layer.point[std::size_t(i)], *samples, *own, s);
            *samples = std::clamp(value, -limit, limit);
            ++samples;
            ++own;
        });
    });
}

}  // namespace vdbsynth
