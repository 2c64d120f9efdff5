// The distances that an analogy's sources give.
#include "libvdbsynth/analogy/volume_analogy.h"
#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

bool fullAt(const std::vector<DepthRun>& depths, float plain) {
    const int depth = int(std::lround(std::clamp(plain, -1e6f, 1e6f)));
    bool full = depths.front().full;
    for (const DepthRun& run : depths)
        if (run.from <= depth) full = run.full;
    return full;
}

}  // namespace

BrickField readAnalogy(const ElementSources& sources, const std::vector<DepthRun>& depths,
                       const IndexBox& mapBox, const std::vector<ExemplarSamples>& textured,
                       const BrickField& target, int factor, const RunContext& ctx) {
    if (depths.empty() || finerBox(mapBox, factor).size() != target.box().size())
        throw Error(ErrorCode::ShapeMismatch, "the sources are of another target");
    const float far = kAnalogyFar * float(factor);
    const Index3 first = finerBox(mapBox, factor).min;
    const BrickField otherwise =
        BrickField::generate(target.box(), ctx, [&](const IndexBox& brick, float* samples) {
            target.readBox(brick.min, brick.size(), samples);
            for (int i = 0; i < BrickField::kSamples; ++i) {
                float plain = samples[i];
                if (factor > 1) {
                    // By the map's voxel as a whole, whose middle is at a multiple of the factor.
                    const Index3 p = brick.min + Index3{i >> 6, (i >> 3) & 7, i & 7};
                    const Index3 voxel = mapBox.min + Index3{p.x / factor, p.y / factor, p.z / factor};
                    plain = target.at(voxel * factor - first) / float(factor);
                }
                samples[i] = fullAt(depths, plain) ? -far : far;
            }
        });
    return gatherThroughSources(sources, mapBox, factor, textured, otherwise, far, ctx);
}

}  // namespace vdbsynth
