// The volume that a field's zero level encloses.
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/solid/surface_loss.h"

#include <numeric>

namespace vdbsynth {
namespace {

// Share of a cell that is inside, from its corners, x slowest.
double insideShare(const float (&v)[8]) {
    constexpr float kPlaces[4] = {0.125f, 0.375f, 0.625f, 0.875f};
    const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
    int inside = 0;
    for (float x : kPlaces)
        for (float y : kPlaces) {
            const float low = mix(mix(v[0], v[4], x), mix(v[2], v[6], x), y),
                        high = mix(mix(v[1], v[5], x), mix(v[3], v[7], x), y);
            for (float z : kPlaces) inside += mix(low, high, z) < 0 ? 1 : 0;
        }
    return inside / 64.0;
}

}  // namespace

double enclosedVolume(const BrickField& field, const RunContext& ctx) {
    constexpr int kSide = BrickField::kSide, kPadded = kSide + 1;
    const IndexBox& box = field.box();
    std::vector<Index3> corners;
    forEachVoxel(
        box, [&](const Index3& p) { corners.push_back(p); }, kSide);
    std::vector<double> volumes(corners.size(), 0);
    parallelFor(ctx, corners.size(), 16, [&](std::size_t begin, std::size_t end) {
        float values[kPadded * kPadded * kPadded];
        for (std::size_t i = begin; i < end; ++i) {
            float value = 0;
            const IndexBox cells = IndexBox::cube(corners[i], kPadded).intersection(box);
            if (field.constantIn(cells, value)) {
                const Index3 size = IndexBox::cube(corners[i], kSide).intersection(box).size();
                volumes[i] = value < 0 ? double(latticeCount(size)) : 0;
                continue;
            }
            field.readBox(corners[i], {kPadded, kPadded, kPadded}, values);
            forEachVoxel(IndexBox::fromSize({kSide, kSide, kSide}), [&](const Index3& p) {
                if (!box.contains(p + corners[i])) return;
                float v[8];
                int below = 0;
                for (int c = 0; c < 8; ++c) {
                    v[c] = values[latticeIndex(p + Index3{c >> 2, c >> 1 & 1, c & 1},
                                               {kPadded, kPadded, kPadded})];
                    below += v[c] < 0 ? 1 : 0;
                }
                volumes[i] += below == 8 ? 1 : below == 0 ? 0 : insideShare(v);
            });
        }
    });
    return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

}  // namespace vdbsynth
