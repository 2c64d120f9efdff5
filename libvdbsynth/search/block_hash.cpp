#include "libvdbsynth/search/block_hash.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/math/lattice.h"

#include <array>
#include <cstring>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kGroup = kPositionGroup;
// Side of the regions of positions hashed together: a block's samples are read per region, not per group.
constexpr int kRegion = 32;
static_assert(kRegion % kGroup == 0);

std::uint64_t mix(float value) {
    std::uint32_t bits = 0;
    if (value != 0.f) std::memcpy(&bits, &value, sizeof bits);  // -0 and +0 are equal
    std::uint64_t x = bits + 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

constexpr std::uint64_t kBase[3] = {0x9E3779B97F4A7C15ull, 0xC2B2AE3D27D4EB4Full, 0x165667B19E3779F9ull};

// The hashRegion value of a constant block.
std::uint64_t constantHash(float value, int block) {
    std::uint64_t hash = mix(value);
    for (std::uint64_t base : kBase) {
        std::uint64_t sum = 0;
        for (int k = 0; k < block; ++k) sum = sum * base + hash;
        hash = sum;
    }
    return hash;
}

// Sums of `block` terms along one axis for every position, each term weighted by a power of the base: the
// next sum is the last one without its first term plus one more. In place; `stride` from term to term,
// `width` neighbours in parallel.
void rollSums(std::uint64_t* values, int length, int block, std::size_t stride, std::size_t width,
              std::uint64_t base, std::vector<std::uint64_t>& scratch) {
    std::uint64_t top = 1;
    for (int k = 1; k < block; ++k) top *= base;
    scratch.assign(width, 0);
    std::uint64_t* sums = scratch.data();
    for (int k = 0; k < block; ++k)
        for (std::size_t i = 0; i < width; ++i)
            sums[i] = sums[i] * base + values[std::size_t(k) * stride + i];
    for (int place = 0; place + block <= length; ++place) {
        std::uint64_t* first = values + std::size_t(place) * stride;
        const std::uint64_t* next = place + block < length ? first + std::size_t(block) * stride : nullptr;
        for (std::size_t i = 0; i < width; ++i) {
            const std::uint64_t sum = sums[i], without = sum - first[i] * top;
            first[i] = sum;
            sums[i] = without * base + (next ? next[i] : 0);
        }
    }
}

// Polynomial hash of every block of a region with side `block`, at its minimum corner: sums along z, y, x,
// each with its own odd base.
void hashRegion(const Index3& size, int block, std::vector<std::uint64_t>& values) {
    const std::size_t nx = std::size_t(size.x), ny = std::size_t(size.y), nz = std::size_t(size.z);
    std::vector<std::uint64_t> scratch;
    for (std::size_t row = 0; row < nx * ny; ++row)
        rollSums(values.data() + row * nz, size.z, block, 1, 1, kBase[0], scratch);
    for (std::size_t x = 0; x < nx; ++x)
        rollSums(values.data() + x * ny * nz, size.y, block, nz, nz, kBase[1], scratch);
    rollSums(values.data(), size.x, block, ny * nz, ny * nz, kBase[2], scratch);
}

// Constant blocks are hashed row by row of groups along z, as runs; all others region by region.
class Hashing {
public:
    Hashing(const BlockIndexData& data, const RunContext& ctx) : mData(data), mContext(ctx) {
        const Index3 size = data.positions.size();
        for (int axis = 0; axis < 3; ++axis) mGroups[axis] = (size[axis] + kGroup - 1) / kGroup;
    }

    // Groups of positions whose blocks are not all constant; they account for most of an index's cost.
    std::size_t variedGroups() const {
        const std::size_t rows = std::size_t(mGroups.x) * std::size_t(mGroups.y);
        std::vector<std::size_t> counts(rows, 0);
        parallelFor(mContext, rows, 16, [&](std::size_t begin, std::size_t end) {
            float value = 0;
            for (std::size_t row = begin; row < end; ++row)
                for (int g = 0; g < mGroups.z; ++g) counts[row] += isConstant(corner(row, g), value) ? 0 : 1;
        });
        std::size_t total = 0;
        for (std::size_t count : counts) total += count;
        return total;
    }

    // All eligible blocks.
    std::vector<Hashed> run() const {
        const Index3 size = mData.positions.size();
        Index3 regions;
        for (int axis = 0; axis < 3; ++axis) regions[axis] = (size[axis] + kRegion - 1) / kRegion;
        const std::size_t rows = std::size_t(mGroups.x) * std::size_t(mGroups.y),
                          count = latticeCount(regions);
        std::vector<std::vector<Hashed>> found(rows + count);
        parallelFor(mContext, rows, 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) hashConstants(row, found[row]);
        });
        parallelFor(mContext, count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t r = begin; r < end; ++r) {
                hashVaried(latticeVoxel(r, regions) * kRegion, found[rows + r]);
            }
        });
        std::vector<Hashed> all;
        for (auto& part : found) {
            all.insert(all.end(), part.begin(), part.end());
            std::vector<Hashed>().swap(part);
        }
        return all;
    }

private:
    Index3 corner(std::size_t row, int group) const {
        return {int(row / std::size_t(mGroups.y)) * kGroup, int(row % std::size_t(mGroups.y)) * kGroup,
                group * kGroup};
    }
    bool isConstant(const Index3& at, float& value) const {
        return mData.exemplar->constantIn(IndexBox::cube(at, mData.block + kGroup - 1), value);
    }

    void hashConstants(std::size_t row, std::vector<Hashed>& found) const {
        // Index in `found` of each row's run of constant blocks that may still grow.
        std::array<std::size_t, kGroup * kGroup> open;
        open.fill(kNone);
        for (int group = 0; group < mGroups.z; ++group) {
            const Index3 at = corner(row, group);
            float value = 0;
            if (isConstant(at, value))
                addConstant(at, constantHash(value, mData.block), open, found);
            else
                open.fill(kNone);
        }
    }

    // Blocks of those groups of a region that are not constant.
    void hashVaried(const Index3& at, std::vector<Hashed>& found) const {
        const IndexBox blocks = IndexBox::cube(at, kRegion).intersection(mData.positions);
        std::vector<Index3> varied;
        float value = 0;
        const auto addVaried = [&](const Index3& p) {
            if (!isConstant(p, value)) varied.push_back(p);
        };
        forEachVoxel(blocks, addVaried, kGroup);
        if (varied.empty()) return;
        const int more = mData.block - 1;
        const Index3 size = blocks.size() + Index3{more, more, more};
        const std::size_t count = latticeCount(size);
        std::vector<float> samples(count);
        mData.exemplar->readBox(at, size, samples.data());
        std::vector<std::uint64_t> hashes(count);
        for (std::size_t i = 0; i < count; ++i) hashes[i] = mix(samples[i]);
        hashRegion(size, mData.block, hashes);
        for (const Index3& group : varied)
            forEachVoxel(IndexBox::cube(group, kGroup).intersection(blocks), [&](const Index3& p) {
                if (!mData.eligible(p)) return;
                found.push_back({hashes[latticeIndex(p - at, size)], {mData.numberOf(p), 1}});
            });
    }

    void addConstant(const Index3& at, std::uint64_t hash, std::array<std::size_t, kGroup * kGroup>& open,
                     std::vector<Hashed>& found) const {
        forEachVoxel(IndexBox::cube(at, kGroup).intersection(mData.positions), [&](const Index3& p) {
            if (!mData.eligible(p)) return;
            std::size_t& run = open[std::size_t((p.x - at.x) * kGroup + p.y - at.y)];
            const std::uint64_t number = mData.numberOf(p);
            if (run != kNone && found[run].hash == hash &&
                found[run].run.first + found[run].run.length == number) {
                ++found[run].run.length;
                return;
            }
            run = found.size();
            found.push_back({hash, {number, 1}});
        });
    }

    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    const BlockIndexData& mData;
    const RunContext& mContext;
    Index3 mGroups;
};

}  // namespace

std::size_t countVariedGroups(const BlockIndexData& data, const RunContext& ctx) {
    return Hashing(data, ctx).variedGroups();
}

std::vector<Hashed> hashBlocks(const BlockIndexData& data, const RunContext& ctx) {
    return Hashing(data, ctx).run();
}

}  // namespace vdbsynth
