#include "libvdbsynth/analogy/volume_analogy_steps.h"

#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr float kSurface = 0.9f;  // [voxels] from the surface within which patches grow

}  // namespace

PatchLayout::PatchLayout(const AnalogyVoxels& voxels, const BrickField& plain,
                         const AnalogyTraining& training, const RunContext& ctx)
    : mVoxels(voxels), mPlain(plain), mTraining(training), mPlaced(voxels.table.size()) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < mPlaced.size(); ++i)
        if (onSurface(i)) order.push_back({hash64(&i, sizeof i, ctx.seed), i});
    std::sort(order.begin(), order.end());
    std::vector<std::int32_t> seeds;
    for (std::size_t r = 0; r < training.size(); ++r)
        if (std::abs(training.plainAt(training.row(std::int32_t(r)))) < kSurface)
            seeds.push_back(std::int32_t(r));
    if (seeds.empty()) return;
    for (const auto& [key, i] : order)
        if (mPlaced[i].pair < 0) grow(i, seeds[std::size_t(key % seeds.size())]);
}

AnalogySource PatchLayout::sourceOf(std::size_t i) const {
    const Index3& v = mVoxels.table[i];
    const float depth = mPlain.inside(v);
    const Vec3f foot = middleOf(v) - mVoxels.frame[i].n * depth;
    const Index3 base = nearestVoxel(foot);
    std::int32_t nearest = -1;
    float best = 1e9f;
    forEachVoxel(IndexBox{base, base}.expanded(1), [&](const Index3& p) {
        const std::int32_t j = mVoxels.table.find(p);
        if (j < 0 || mPlaced[std::size_t(j)].pair < 0) return;
        const Vec3f offset = middleOf(mVoxels.table[std::size_t(j)]) - foot;
        if (dot(offset, offset) >= best) return;
        best = dot(offset, offset);
        nearest = j;
    });
    if (nearest < 0) return {};
    const Placed& placed = mPlaced[std::size_t(nearest)];
    const Frame& frame = mTraining.frame(mTraining.row(placed.row));
    const Vec3f beside = rotated(mVoxels.frame[std::size_t(nearest)], frame,
                                 foot - middleOf(mVoxels.table[std::size_t(nearest)]));
    const Vec3f at = placed.at + (beside - frame.n * dot(frame.n, beside)) +
                     frame.n * (depth - mTraining.plainAt(mTraining.row(placed.row)));
    return mTraining.sourceAt(placed.pair, at);
}

bool PatchLayout::onSurface(std::size_t i) const {
    return std::abs(mPlain.inside(mVoxels.table[i])) < kSurface;
}

void PatchLayout::grow(std::uint32_t first, std::int32_t seed) {
    const AnalogyRow& begin = mTraining.row(seed);
    const int reach = mTraining.patchReach(begin.pair);
    mPlaced[first] = {begin.pair, seed, middleOf(mTraining.voxel(begin))};
    std::vector<std::pair<std::uint32_t, int>> queue{{first, 0}};
    for (std::size_t next = 0; next < queue.size(); ++next) {
        const auto [i, steps] = queue[next];
        if (steps == reach) continue;
        const Placed from = mPlaced[i];
        const Frame& frame = mTraining.frame(mTraining.row(from.row));
        for (const Index3& offset : kAllNeighbours) {
            const std::int32_t j = mVoxels.table.find(mVoxels.table[i] + offset);
            if (j < 0 || mPlaced[std::size_t(j)].pair >= 0 || !onSurface(std::size_t(j)) ||
                dot(mVoxels.frame[i].n, mVoxels.frame[std::size_t(j)].n) <= 0)
                continue;
            Vec3f at = from.at + rotated(mVoxels.frame[i], frame, middleOf(offset));
            std::int32_t row = mTraining.find(from.pair, nearestVoxel(at));
            if (row < 0) continue;
            // Back to the depth of the voxel, which steps along a tangent leave.
            const AnalogyRow& source = mTraining.row(row);
            at = at + mTraining.frame(source).n *
                          (mPlain.inside(mVoxels.table[std::size_t(j)]) - mTraining.plainThrough(source, at));
            row = mTraining.find(from.pair, nearestVoxel(at));
            if (row < 0) continue;
            mPlaced[std::size_t(j)] = {from.pair, row, at};
            queue.push_back({std::uint32_t(j), steps + 1});
        }
    }
}

}  // namespace vdbsynth
