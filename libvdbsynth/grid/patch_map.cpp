#include "libvdbsynth/grid/patch_map.h"

#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

struct Span {
    int first, last;
};

}  // namespace

Index3 PatchMap::lattice() const {
    Index3 n;
    for (int axis = 0; axis < 3; ++axis)
        n[axis] = (std::max(target[axis] + overhang[axis] - block, 0) + stride - 1) / stride + 1;
    return n;
}

int PatchMap::origin(int axis, int a) const {
    return std::min(a * stride, std::max(target[axis] + overhang[axis] - block, 0));
}

void PatchMap::covering(int axis, int p, int& first, int& last) const {
    const int count = lattice()[axis];
    first = std::clamp((p - block) / stride, 0, count - 1);
    while (first + 1 < count && origin(axis, first) + block <= p) ++first;
    last = first;
    while (last + 1 < count && origin(axis, last + 1) <= p) ++last;
}

void PatchMap::allocate() {
    const Index3 n = lattice();
    const std::size_t count = std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z);
    source.assign(count, Index3{});
    exemplar.assign(count, 0);
}

PatchMap PatchMap::scaled(int factor, const Index3& newTarget) const {
    PatchMap map = *this;
    map.target = newTarget;
    map.block = block * factor;
    map.stride = stride * factor;
    for (int axis = 0; axis < 3; ++axis)
        map.overhang[axis] = (target[axis] + overhang[axis]) * factor - newTarget[axis];
    for (Index3& s : map.source) s = s * factor;
    if (map.overhang.x < 0 || map.overhang.y < 0 || map.overhang.z < 0 || map.lattice() != lattice())
        throw Error(ErrorCode::ShapeMismatch,
                    "a source map of " + std::to_string(target.x) + " x " + std::to_string(target.y) + " x " +
                        std::to_string(target.z) + " voxels does not scale to the size asked for");
    return map;
}

float voteWeight(int block, int i) {
    const float tent = std::min(float(i) + 0.5f, float(block - i) - 0.5f);
    return tent * tent;
}

Index3 strongestBlock(const PatchMap& map, const Index3& voxel) {
    Index3 best;
    for (int axis = 0; axis < 3; ++axis) {
        int first, last;
        map.covering(axis, voxel[axis], first, last);
        best[axis] = first;
        for (int a = first; a <= last; ++a)
            if (voteWeight(map.block, voxel[axis] - map.origin(axis, a)) >
                voteWeight(map.block, voxel[axis] - map.origin(axis, best[axis])))
                best[axis] = a;
    }
    return best;
}

BrickField voteThroughMap(const PatchMap& map,
                          const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                          const RunContext& ctx) {
    std::vector<float> weight(std::size_t(map.block));
    for (int i = 0; i < map.block; ++i) weight[std::size_t(i)] = voteWeight(map.block, i);
    return BrickField::generate(
        IndexBox::fromSize(map.target), ctx, [&](const IndexBox& brick, float* samples) {
            Span span[3];
            for (int axis = 0; axis < 3; ++axis) {
                int ignored;
                map.covering(axis, brick.min[axis], span[axis].first, ignored);
                map.covering(axis, std::min(brick.max[axis], map.target[axis] - 1), ignored, span[axis].last);
            }
            double sum[BrickField::kSamples] = {}, total[BrickField::kSamples] = {};
            float values[BrickField::kSamples];
            bool constant = true;
            float first = 0;
            bool any = false;
            for (int a = span[0].first; a <= span[0].last; ++a)
                for (int b = span[1].first; b <= span[1].last; ++b)
                    for (int c = span[2].first; c <= span[2].last; ++c) {
                        const Index3 origin{map.origin(0, a), map.origin(1, b), map.origin(2, c)};
                        const IndexBox part = brick.intersection(IndexBox::cube(origin, map.block));
                        if (part.empty()) continue;
                        const std::size_t l = map.index({a, b, c});
                        const Index3 size = part.size();
                        exemplars[std::size_t(map.exemplar[l])]->readBox(map.source[l] + part.min - origin,
                                                                         size, values);
                        const float* value = values;
                        for (int x = part.min.x; x <= part.max.x; ++x)
                            for (int y = part.min.y; y <= part.max.y; ++y)
                                for (int z = part.min.z; z <= part.max.z; ++z, ++value) {
                                    if (!any) first = *value;
                                    any = true;
                                    constant = constant && *value == first;
                                    const double w = double(weight[std::size_t(x - origin.x)]) *
                                                     double(weight[std::size_t(y - origin.y)]) *
                                                     double(weight[std::size_t(z - origin.z)]);
                                    const std::size_t i =
                                        std::size_t(((x - brick.min.x) * kSide + y - brick.min.y) * kSide +
                                                    z - brick.min.z);
                                    sum[i] += w * double(*value);
                                    total[i] += w;
                                }
                    }
            for (int i = 0; i < BrickField::kSamples; ++i)
                samples[i] = constant       ? first
                             : total[i] > 0 ? float(sum[i] / total[i])
                                            : samples[i > 0 ? i - 1 : 0];
        });
}

}  // namespace vdbsynth
