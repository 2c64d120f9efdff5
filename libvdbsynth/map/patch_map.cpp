#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/grid/dense_field.h"

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

// True if test(number of the block, its place) holds for all blocks of a span.
template <typename Test>
bool everyBlock(const Span span[3], const Index3& lattice, const Test& test) {
    for (int a = span[0].first; a <= span[0].last; ++a)
        for (int b = span[1].first; b <= span[1].last; ++b) {
            const std::size_t row =
                (std::size_t(a) * std::size_t(lattice.y) + std::size_t(b)) * std::size_t(lattice.z);
            for (int c = span[2].first; c <= span[2].last; ++c)
                if (!test(row + std::size_t(c), Index3{a, b, c})) return false;
        }
    return true;
}

// The one value of all blocks of a span, or not a number.
float sharedConstant(const Index3& lattice, const Span span[3], std::size_t first,
                     const std::vector<float>& constants) {
    const bool same = everyBlock(
        span, lattice, [&](std::size_t i, const Index3&) { return constants[i] == constants[first]; });
    return same ? constants[first] : std::numeric_limits<float>::quiet_NaN();
}

// True if all blocks of a span propose the same for what they share.
bool sharedSource(const PatchMap& map, const Index3& lattice, const Span span[3], std::size_t first) {
    const Index3 shift = map.source[first] - map.originOf({span[0].first, span[1].first, span[2].first});
    return everyBlock(span, lattice, [&](std::size_t i, const Index3& place) {
        return map.exemplar[i] == map.exemplar[first] && map.source[i] - map.originOf(place) == shift;
    });
}

// What blocks say of the samples of one brick.
struct BrickVotes {
    double sum[BrickField::kSamples] = {}, total[BrickField::kSamples] = {};

    // Samples beyond the target, which are never read, go on from the one before.
    void write(float* samples) const {
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = total[i] > 0 ? float(sum[i] / total[i]) : i > 0 ? samples[i - 1] : 0.f;
    }
};

// One block's say on a part of a brick.
struct Say {
    double weight;              // of the block
    const double *x, *y, *z;    // weights along the part's axes
    const float* values;        // first sample of the part
    std::ptrdiff_t plane, row;  // steps from plane to plane and row to row of the values
    Index3 size;                // of the part
    int first;                  // its first sample in the brick
};

// The same bits with and without wide registers.
__attribute__((target_clones("avx2", "default"))) void blend(const Say& say, double* sum, double* total) {
    for (int x = 0; x < say.size.x; ++x)
        for (int y = 0; y < say.size.y; ++y) {
            const double across = say.weight * say.x[x] * say.y[y];
            const double* along = say.z;
            const float* value = say.values + x * say.plane + y * say.row;
            double* sums = sum + say.first + (x * kSide + y) * kSide;
            double* totals = total + say.first + (x * kSide + y) * kSide;
            for (int k = 0; k < say.size.z; ++k) {
                const double w = across * along[k];
                sums[k] += w * double(value[k]);
                totals[k] += w;
            }
        }
}

void fillOpen(const Say& say, double* sum, double* total) {
    for (int x = 0; x < say.size.x; ++x)
        for (int y = 0; y < say.size.y; ++y)
            for (int k = 0; k < say.size.z; ++k) {
                const int i = say.first + (x * kSide + y) * kSide + k;
                if (total[i] != 0) continue;
                total[i] = say.weight * say.x[x] * say.y[y] * say.z[k];
                sum[i] = total[i] * double(say.values[x * say.plane + y * say.row + k]);
            }
}

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

float blockWeight(const PatchMap& map, const Index3& block, const Index3& voxel) {
    float say = map.weight.empty() ? 1.f : map.weight[map.index(block)];
    const Index3 offset = voxel - map.originOf(block);
    for (int axis = 0; axis < 3; ++axis) say *= voteWeight(map.block, offset[axis]);
    return say;
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
                const float say = blockWeight(map, {a, b, c}, voxel);
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
    const Index3 lattice = map.lattice();
    return BrickField::generate(
        IndexBox::fromSize(map.target), ctx, [&](const IndexBox& brick, float* samples) {
            Span span[3];
            for (int axis = 0; axis < 3; ++axis) {
                int ignored;
                map.covering(axis, brick.min[axis], span[axis].first, ignored);
                map.covering(axis, std::min(brick.max[axis], map.target[axis] - 1), ignored, span[axis].last);
            }
            const Index3 corner{span[0].first, span[1].first, span[2].first};
            const std::size_t first = map.index(corner);
            const float shared = sharedConstant(lattice, span, first, constants);
            if (!std::isnan(shared)) {
                std::fill(samples, samples + BrickField::kSamples, shared);
                return;
            }
            // The mean of equal samples is that sample, to the last bit: sums are double, samples are not.
            if (IndexBox::fromSize(map.target).contains(brick) && sharedSource(map, lattice, span, first)) {
                exemplars[std::size_t(map.exemplar[first])]->readBox(
                    brick.min + map.source[first] - map.originOf(corner), brick.size(), samples);
                return;
            }
            BrickVotes votes;
            for (int a = span[0].first; a <= span[0].last; ++a)
                for (int b = span[1].first; b <= span[1].last; ++b)
                    for (int c = span[2].first; c <= span[2].last; ++c) {
                        const Index3 origin = map.originOf({a, b, c});
                        const IndexBox part = brick.intersection(IndexBox::cube(origin, map.block));
                        if (part.empty()) continue;
                        const std::size_t l = (std::size_t(a) * std::size_t(lattice.y) + std::size_t(b)) *
                                                  std::size_t(lattice.z) +
                                              std::size_t(c);
                        const std::size_t e = std::size_t(map.exemplar[l]);
                        const Index3 from = map.source[l] + part.min - origin, at = part.min - brick.min,
                                     skip = part.min - origin;
                        Say say;
                        say.weight = map.weight.empty() ? 1 : double(map.weight[l]);
                        say.x = weight.data() + skip.x;
                        say.y = weight.data() + skip.y;
                        say.z = weight.data() + skip.z;
                        say.size = part.size();
                        say.first = (at.x * kSide + at.y) * kSide + at.z;
                        float values[BrickField::kSamples];
                        const Index3 held = dense ? (*dense)[e].size : say.size;
                        if (!dense) exemplars[e]->readBox(from, say.size, values);
                        say.values = dense ? (*dense)[e].row(from.x, from.y, from.z) : values;
                        say.plane = std::ptrdiff_t(held.y) * held.z;
                        say.row = held.z;
                        (map.vote == PatchVote::Blend ? blend : fillOpen)(say, votes.sum, votes.total);
                    }
            votes.write(samples);
        });
}

}  // namespace vdbsynth
