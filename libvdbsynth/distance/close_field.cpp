#include "libvdbsynth/distance/close_field.h"

#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {

BrickField closeField(const BrickField& field, const IndexBox& domain, const CutFaces& cut, float limit,
                      const RunContext& ctx, float unit) {
    const int margin = int(std::ceil(limit));  // the whole band outside the caps
    return BrickField::generate(domain.expanded(margin), ctx, [&](const IndexBox& brick, float* samples) {
        field.readBox(brick.min, brick.size(), samples);
        forEachVoxel(brick, [&](const Index3& p) {
            float value = std::clamp(*samples, -limit, limit);
            for (int axis = 0; axis < 3; ++axis) {
                const float low = float(domain.min[axis] - p[axis]) - 0.5f,
                            high = float(p[axis] - domain.max[axis]) - 0.5f;
                if (cut[std::size_t(2 * axis)] || low > 0) value = std::max(value, low);
                if (cut[std::size_t(2 * axis + 1)] || high > 0) value = std::max(value, high);
            }
            *samples++ = std::min(value, limit) * unit;
        });
    });
}

}  // namespace vdbsynth
