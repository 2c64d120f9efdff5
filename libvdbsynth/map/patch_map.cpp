#include "libvdbsynth/map/patch_map.h"
#include "libvdbsynth/grid/dense_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr int kSide = BrickField::kSide;

// The value of each block whose source is constant, else NaN.
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

// True if test(index of the block, its position) holds for all blocks of a span.
template <typename Test>
bool everyBlock(const IndexBox& span, const Index3& lattice, const Test& test) {
    for (int a = span.min.x; a <= span.max.x; ++a)
        for (int b = span.min.y; b <= span.max.y; ++b)
            for (int c = span.min.z; c <= span.max.z; ++c)
                if (!test(latticeIndex({a, b, c}, lattice), Index3{a, b, c})) return false;
    return true;
}

// The constant value of all blocks of a span, or NaN.
float sharedConstant(const Index3& lattice, const IndexBox& span, std::size_t first,
                     const std::vector<float>& constants) {
    const bool same = everyBlock(
        span, lattice, [&](std::size_t i, const Index3&) { return constants[i] == constants[first]; });
    return same ? constants[first] : std::numeric_limits<float>::quiet_NaN();
}

// True if all blocks of a span propose the same for what they share.
bool sharedSource(const PatchMap& map, const Index3& lattice, const IndexBox& span, std::size_t first) {
    const Index3 shift = map.source[first] - map.originOf(span.min);
    return everyBlock(span, lattice, [&](std::size_t i, const Index3& place) {
        return map.exemplar[i] == map.exemplar[first] && map.source[i] - map.originOf(place) == shift;
    });
}

// What blocks vote of the samples of one brick.
struct BrickVotes {
    double sum[BrickField::kSamples] = {}, total[BrickField::kSamples] = {};

    // Samples beyond the target, which are never read, repeat the previous one.
    void write(float* samples) const {
        for (int i = 0; i < BrickField::kSamples; ++i)
            samples[i] = total[i] > 0 ? float(sum[i] / total[i]) : i > 0 ? samples[i - 1] : 0.f;
    }
};

// One block's vote on a part of a brick.
struct BlockVote {
    double weight;              // of the block
    const double *x, *y, *z;    // weights along the part's axes
    const float* values;        // first sample of the part
    std::ptrdiff_t plane, row;  // steps from plane to plane and row to row of the values
    Index3 size;                // of the part
    int first;                  // its first sample in the brick
};

// The same bits with and without wide registers.
__attribute__((target_clones("avx2", "default"))) void blend(const BlockVote& vote, double* sum,
                                                             double* total) {
    for (int x = 0; x < vote.size.x; ++x)
        for (int y = 0; y < vote.size.y; ++y) {
            const double across = vote.weight * vote.x[x] * vote.y[y];
            const double* along = vote.z;
            const float* value = vote.values + x * vote.plane + y * vote.row;
            double* sums = sum + vote.first + (x * kSide + y) * kSide;
            double* totals = total + vote.first + (x * kSide + y) * kSide;
            for (int k = 0; k < vote.size.z; ++k) {
                const double w = across * along[k];
                sums[k] += w * double(value[k]);
                totals[k] += w;
            }
        }
}

void fillOpen(const BlockVote& vote, double* sum, double* total) {
    forEachVoxel(IndexBox::fromSize(vote.size), [&](const Index3& p) {
        const int i = vote.first + (p.x * kSide + p.y) * kSide + p.z;
        if (total[i] != 0) return;
        total[i] = vote.weight * vote.x[p.x] * vote.y[p.y] * vote.z[p.z];
        sum[i] = total[i] * double(vote.values[p.x * vote.plane + p.y * vote.row + p.z]);
    });
}

}  // namespace

Index3 PatchMap::place(std::size_t i) const {
    return latticeVoxel(i, lattice());
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
    const std::size_t count = latticeCount(lattice());
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
                        std::to_string(target.z) + " voxels cannot be scaled to the requested size");
    return map;
}

float voteWeight(int block, int i) {
    const float tent = std::min(float(i) + 0.5f, float(block - i) - 0.5f);
    return tent * tent;
}

float blockWeight(const PatchMap& map, const Index3& block, const Index3& voxel) {
    float weight = map.weight.empty() ? 1.f : map.weight[map.index(block)];
    const Index3 offset = voxel - map.originOf(block);
    for (int axis = 0; axis < 3; ++axis) weight *= voteWeight(map.block, offset[axis]);
    return weight;
}

Index3 strongestBlock(const PatchMap& map, const Index3& voxel) {
    IndexBox over;
    for (int axis = 0; axis < 3; ++axis) map.covering(axis, voxel[axis], over.min[axis], over.max[axis]);
    Index3 best = over.min;
    if (map.vote == PatchVote::First) return best;
    float most = -1;
    forEachVoxel(over, [&](const Index3& block) {
        const float weight = blockWeight(map, block, voxel);
        if (weight > most) {
            most = weight;
            best = block;
        }
    });
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
            IndexBox span;
            for (int axis = 0; axis < 3; ++axis) {
                int ignored;
                map.covering(axis, brick.min[axis], span.min[axis], ignored);
                map.covering(axis, std::min(brick.max[axis], map.target[axis] - 1), ignored, span.max[axis]);
            }
            const std::size_t first = map.index(span.min);
            const float shared = sharedConstant(lattice, span, first, constants);
            if (!std::isnan(shared)) {
                std::fill(samples, samples + BrickField::kSamples, shared);
                return;
            }
            // The mean of equal samples is that sample, to the last bit: sums are double, samples float.
            if (IndexBox::fromSize(map.target).contains(brick) && sharedSource(map, lattice, span, first)) {
                exemplars[std::size_t(map.exemplar[first])]->readBox(
                    brick.min + map.source[first] - map.originOf(span.min), brick.size(), samples);
                return;
            }
            BrickVotes votes;
            forEachVoxel(span, [&](const Index3& block) {
                const Index3 origin = map.originOf(block);
                const IndexBox part = brick.intersection(IndexBox::cube(origin, map.block));
                if (part.empty()) return;
                const std::size_t l = latticeIndex(block, lattice), e = std::size_t(map.exemplar[l]);
                const Index3 from = map.source[l] + part.min - origin, at = part.min - brick.min,
                             skip = part.min - origin;
                BlockVote vote;
                vote.weight = map.weight.empty() ? 1 : double(map.weight[l]);
                vote.x = weight.data() + skip.x;
                vote.y = weight.data() + skip.y;
                vote.z = weight.data() + skip.z;
                vote.size = part.size();
                vote.first = (at.x * kSide + at.y) * kSide + at.z;
                float values[BrickField::kSamples];
                const Index3 held = dense ? (*dense)[e].size : vote.size;
                if (!dense) exemplars[e]->readBox(from, vote.size, values);
                vote.values = dense ? (*dense)[e].row(from.x, from.y, from.z) : values;
                vote.plane = std::ptrdiff_t(held.y) * held.z;
                vote.row = held.z;
                (map.vote == PatchVote::Blend ? blend : fillOpen)(vote, votes.sum, votes.total);
            });
            votes.write(samples);
        });
}

}  // namespace vdbsynth
