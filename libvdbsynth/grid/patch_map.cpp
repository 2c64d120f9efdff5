#include "libvdbsynth/grid/patch_map.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

struct Span {
    int first, last;
};

// The value of each block whose source has but one, else not a number.
std::vector<float> constantSources(const PatchMap& map,
                                   const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                                   const RunContext& ctx) {
    std::vector<float> constants(map.source.size());
    parallelFor(ctx, constants.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float value;
            constants[i] = exemplars[std::size_t(map.exemplar[i])]->constantIn(
                               IndexBox::cube(map.source[i], map.block), value)
                               ? value
                               : std::numeric_limits<float>::quiet_NaN();
        }
    });
    return constants;
}

// The one value of all blocks of a span, or not a number.
float sharedConstant(const PatchMap& map, const Span span[3], const std::vector<float>& constants) {
    const float first = constants[map.index({span[0].first, span[1].first, span[2].first})];
    for (int a = span[0].first; a <= span[0].last; ++a)
        for (int b = span[1].first; b <= span[1].last; ++b)
            for (int c = span[2].first; c <= span[2].last; ++c)
                if (constants[map.index({a, b, c})] != first) return std::numeric_limits<float>::quiet_NaN();
    return first;
}

// What blocks say of the samples of one brick.
struct BrickVotes {
    double sum[BrickField::kSamples] = {}, total[BrickField::kSamples] = {};

    // @param values  first sample of `part`, steps from plane to plane and row to row of it
    void add(PatchVote vote, const IndexBox& brick, const IndexBox& part, const Index3& origin,
             const std::vector<double>& weight, double say, const float* values, std::ptrdiff_t plane,
             std::ptrdiff_t step) {
        const int length = part.max.z - part.min.z + 1;
        for (int x = part.min.x; x <= part.max.x; ++x)
            for (int y = part.min.y; y <= part.max.y; ++y) {
                const double across =
                    say * weight[std::size_t(x - origin.x)] * weight[std::size_t(y - origin.y)];
                const double* along = weight.data() + (part.min.z - origin.z);
                const float* value = values + (x - part.min.x) * plane + (y - part.min.y) * step;
                const int i =
                    ((x - brick.min.x) * kSide + y - brick.min.y) * kSide + part.min.z - brick.min.z;
                double *sums = sum + i, *totals = total + i;
                for (int k = 0; k < length; ++k) {
                    const bool counts = vote == PatchVote::Blend || totals[k] == 0;
                    const double w = counts ? across * along[k] : 0;
                    sums[k] += w * double(value[k]);
                    totals[k] += w;
                }
            }
    }

    // Samples beyond the target, which are never read, go on from the one before.
    void write(float* samples) const {
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = total[i] > 0 ? float(sum[i] / total[i]) : i > 0 ? samples[i - 1] : 0.f;
    }
};

}  // namespace

Index3 PatchMap::place(std::size_t i) const {
    const Index3 n = lattice();
    return {int(i / std::size_t(n.z) / std::size_t(n.y)), int(i / std::size_t(n.z) % std::size_t(n.y)),
            int(i % std::size_t(n.z))};
}

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
    int first[3], last[3];
    for (int axis = 0; axis < 3; ++axis) map.covering(axis, voxel[axis], first[axis], last[axis]);
    Index3 best{first[0], first[1], first[2]};
    if (map.vote == PatchVote::First) return best;
    float most = -1;
    for (int a = first[0]; a <= last[0]; ++a)
        for (int b = first[1]; b <= last[1]; ++b)
            for (int c = first[2]; c <= last[2]; ++c) {
                float say = map.weight.empty() ? 1.f : map.weight[map.index({a, b, c})];
                const Index3 offset = voxel - map.originOf({a, b, c});
                for (int axis = 0; axis < 3; ++axis) say *= voteWeight(map.block, offset[axis]);
                if (say > most) {
                    most = say;
                    best = {a, b, c};
                }
            }
    return best;
}

BrickField voteThroughMap(const PatchMap& map,
                          const std::vector<std::shared_ptr<const BrickField>>& exemplars,
                          const RunContext& ctx, const std::vector<DenseField>* dense) {
    std::vector<double> weight(std::size_t(map.block));
    for (int i = 0; i < map.block; ++i) weight[std::size_t(i)] = double(voteWeight(map.block, i));
    const std::vector<float> constants = constantSources(map, exemplars, ctx);
    return BrickField::generate(
        IndexBox::fromSize(map.target), ctx, [&](const IndexBox& brick, float* samples) {
            Span span[3];
            for (int axis = 0; axis < 3; ++axis) {
                int ignored;
                map.covering(axis, brick.min[axis], span[axis].first, ignored);
                map.covering(axis, std::min(brick.max[axis], map.target[axis] - 1), ignored, span[axis].last);
            }
            const float shared = sharedConstant(map, span, constants);
            if (!std::isnan(shared)) {
                std::fill(samples, samples + BrickField::kSamples, shared);
                return;
            }
            BrickVotes votes;
            for (int a = span[0].first; a <= span[0].last; ++a)
                for (int b = span[1].first; b <= span[1].last; ++b)
                    for (int c = span[2].first; c <= span[2].last; ++c) {
                        const Index3 origin = map.originOf({a, b, c});
                        const IndexBox part = brick.intersection(IndexBox::cube(origin, map.block));
                        if (part.empty()) continue;
                        const std::size_t l = map.index({a, b, c});
                        const Index3 from = map.source[l] + part.min - origin;
                        const double say = map.weight.empty() ? 1 : double(map.weight[l]);
                        const std::size_t e = std::size_t(map.exemplar[l]);
                        if (dense) {
                            const Index3 size = (*dense)[e].size;
                            votes.add(map.vote, brick, part, origin, weight, say,
                                      (*dense)[e].row(from.x, from.y, from.z),
                                      std::ptrdiff_t(size.y) * size.z, size.z);
                        } else {
                            float values[BrickField::kSamples];
                            const Index3 size = part.size();
                            exemplars[e]->readBox(from, size, values);
                            votes.add(map.vote, brick, part, origin, weight, say, values,
                                      std::ptrdiff_t(size.y) * size.z, size.z);
                        }
                    }
            votes.write(samples);
        });
}

}  // namespace vdbsynth
