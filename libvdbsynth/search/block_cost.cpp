#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <vector>

namespace vdbsynth {
namespace {

constexpr int kLanes =
    8;  // independent sums, so that the compiler may use vector units without changing the order

double slabSum(const float* a, const float* b, const std::uint8_t* known, int samples, double lanes[kLanes]) {
    int i = 0;
    for (; i + kLanes <= samples; i += kLanes)
        for (int lane = 0; lane < kLanes; ++lane) {
            const double d = double(a[i + lane] - b[i + lane]);
            lanes[lane] += known ? (known[i + lane] ? d * d : 0.0) : d * d;
        }
    for (; i < samples; ++i) {
        const double d = double(a[i] - b[i]);
        if (!known || known[i]) lanes[i % kLanes] += d * d;
    }
    double sum = 0;
    for (int lane = 0; lane < kLanes; ++lane) sum += lanes[lane];
    return sum;
}

// @param readSlab  (x, out): the samples of the block's slab x
template <typename ReadSlab>
double costBySlabs(const ReadSlab& readSlab, int block, const float* query, const std::uint8_t* known,
                   std::int64_t count, double giveUp) {
    const int slab = block * block;
    thread_local std::vector<float> values;
    values.resize(std::size_t(slab));
    double lanes[kLanes] = {};
    double cost = 0;
    for (int x = 0; x < block; ++x) {
        readSlab(x, values.data());
        cost = slabSum(values.data(), query + std::ptrdiff_t(x) * slab,
                       known ? known + std::ptrdiff_t(x) * slab : nullptr, slab, lanes) /
               double(count);
        if (cost > giveUp) return cost;
    }
    return cost;
}

}  // namespace

double blockCost(const BrickField& exemplar, const Index3& corner, int block, const float* query,
                 const std::uint8_t* known, std::int64_t count, double giveUp) {
    const auto readSlab = [&](int x, float* out) {
        exemplar.readBox({corner.x + x, corner.y, corner.z}, {1, block, block}, out);
    };
    return costBySlabs(readSlab, block, query, known, count, giveUp);
}

double blockCost(const DenseField& exemplar, const Index3& corner, int block, const float* query,
                 const std::uint8_t* known, std::int64_t count, double giveUp) {
    const auto readSlab = [&](int x, float* out) {
        for (int y = 0; y < block; ++y)
            std::copy_n(exemplar.row(corner.x + x, corner.y + y, corner.z), block, out + y * block);
    };
    return costBySlabs(readSlab, block, query, known, count, giveUp);
}

std::int64_t countKnown(const std::uint8_t* known, int block) {
    const std::int64_t all = std::int64_t(block) * block * block;
    if (!known) return all;
    std::int64_t count = 0;
    for (std::int64_t i = 0; i < all; ++i) count += known[i] ? 1 : 0;
    return count;
}

}  // namespace vdbsynth
