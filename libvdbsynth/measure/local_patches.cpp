// LP-IoU and LP-F on bits: a patch is 21 words, a pair costs 21 ands and counts.
#include "libvdbsynth/measure/local_patches.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>

namespace vdbsynth {
namespace {

constexpr int kSide = 11, kStep = 5, kPad = 5;
constexpr std::size_t kWords = (kSide * kSide * kSide + 63) / 64;
constexpr std::size_t kQueries = 1000;
constexpr std::uint32_t kPurpose = 0x4c5049;

struct BitPatch {
    std::array<std::uint64_t, kWords> bits{};
    int count = 0;
};

bool solidAt(const Occupancy& solid, const Index3& p) {
    return IndexBox::fromSize(solid.size()).contains(p) && solid.at(p.x, p.y, p.z);
}

// The patch with that corner; false if its middle 3^3 is all of one phase.
bool takePatch(const Occupancy& solid, const Index3& corner, BitPatch& patch) {
    int middle = 0;
    forEachVoxel(IndexBox::cube(corner + Index3{4, 4, 4}, 3),
                 [&](const Index3& p) { middle += solidAt(solid, p); });
    if (middle == 0 || middle == 27) return false;
    patch = {};
    std::size_t bit = 0;
    forEachVoxel(IndexBox::cube(corner, kSide), [&](const Index3& p) {
        if (solidAt(solid, p)) {
            patch.bits[bit / 64] |= std::uint64_t(1) << (bit % 64);
            ++patch.count;
        }
        ++bit;
    });
    return true;
}

std::vector<BitPatch> patchesOf(const PatchBits& from, const RunContext& ctx) {
    const Occupancy& solid = from.solid;
    const Index3& size = solid.size();
    const int pad = from.beyond == Beyond::Void ? kPad : 0;
    const auto steps = [pad](int n) { return n + 2 * pad < kSide ? 0 : (n + 2 * pad - kSide) / kStep + 1; };
    std::vector<std::vector<BitPatch>> planes{static_cast<std::size_t>(steps(size.x))};
    parallelFor(ctx, planes.size(), 1, [&](std::size_t begin, std::size_t end) {
        BitPatch patch;
        for (std::size_t a = begin; a < end; ++a)
            for (int b = 0; b < steps(size.y); ++b)
                for (int c = 0; c < steps(size.z); ++c)
                    if (takePatch(solid, {int(a) * kStep - pad, b * kStep - pad, c * kStep - pad}, patch))
                        planes[a].push_back(patch);
    });
    std::vector<BitPatch> all;
    for (const std::vector<BitPatch>& plane : planes) all.insert(all.end(), plane.begin(), plane.end());
    return all;
}

// The best intersection over union with any of the patches.
__attribute__((target_clones("popcnt", "default"))) double bestOverlap(const BitPatch& query,
                                                                       const std::vector<BitPatch>& among) {
    double best = 0;
    for (const BitPatch& patch : among) {
        const double most = double(std::min(query.count, patch.count)) / std::max(query.count, patch.count);
        if (most <= best) continue;
        int both = 0;
        for (std::size_t w = 0; w < kWords; ++w) both += __builtin_popcountll(query.bits[w] & patch.bits[w]);
        best = std::max(best, double(both) / double(query.count + patch.count - both));
    }
    return best;
}

}  // namespace

LocalPatches localPatchSimilarity(const PatchBits& reference, const PatchBits& other, const RunContext& ctx) {
    const std::vector<BitPatch> among = patchesOf(reference, ctx);
    std::vector<BitPatch> queries = patchesOf(other, ctx);
    LocalPatches result;
    if (among.empty() || queries.empty()) return result;
    const std::size_t count = std::min(kQueries, queries.size());
    if (count < queries.size())
        for (std::size_t i = 0; i < count; ++i) {
            Random random(ctx.seed, i, kPurpose);
            std::swap(queries[i], queries[i + random.below(std::uint32_t(queries.size() - i))]);
        }
    std::vector<double> best(count);
    parallelFor(ctx, count, 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) best[i] = bestOverlap(queries[i], among);
    });
    for (double overlap : best) {
        // With i = both and s = the sum of the two counts: overlap i / (s - i), F-score 2 i / s.
        const double score = 2 * overlap / (1 + overlap);
        result.shareIoU += overlap > 0.95 ? 1 : 0;
        result.shareScore += score > 0.95 ? 1 : 0;
        result.meanIoU += overlap;
    }
    result.shareIoU /= double(count);
    result.shareScore /= double(count);
    result.meanIoU /= double(count);
    return result;
}

}  // namespace vdbsynth
