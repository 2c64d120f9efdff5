#include "libvdbsynth/search/block_hash.h"

#include "libvdbsynth/base/parallel.h"

#include <array>
#include <cstring>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kGroup = kPositionGroup;

std::uint64_t mix(float value) {
    std::uint32_t bits = 0;
    if (value != 0.f) std::memcpy(&bits, &value, sizeof bits);  // -0 and +0 are one
    std::uint64_t x = bits + 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

constexpr std::uint64_t kBase[3] = {0x9E3779B97F4A7C15ull, 0xC2B2AE3D27D4EB4Full, 0x165667B19E3779F9ull};

// What hashRegion gives for a block of one value.
std::uint64_t constantHash(float value, int block) {
    std::uint64_t hash = mix(value);
    for (std::uint64_t base : kBase) {
        std::uint64_t sum = 0;
        for (int k = 0; k < block; ++k) sum = sum * base + hash;
        hash = sum;
    }
    return hash;
}

// Polynomial hash of every block of an n^3 region with side `block`: three passes of sums along one axis,
// each weighing its terms by the powers of its own odd base. [m x m x m], m = n - block + 1.
void hashRegion(const std::vector<float>& region, int n, int block, std::vector<std::uint64_t>& out) {
    const int m = n - block + 1;
    std::vector<std::uint64_t> in(region.size());
    for (std::size_t i = 0; i < region.size(); ++i) in[i] = mix(region[i]);
    int nx = n, ny = n, nz = n;
    for (int pass = 0; pass < 3; ++pass) {
        // Sums along z, then turns (x,y,z) to (z,x,y).
        out.assign(std::size_t(m) * std::size_t(nx) * std::size_t(ny), 0);
        for (int x = 0; x < nx; ++x)
            for (int y = 0; y < ny; ++y)
                for (int z = 0; z < m; ++z) {
                    const std::uint64_t* row =
                        in.data() + (std::size_t(x) * std::size_t(ny) + std::size_t(y)) * std::size_t(nz) +
                        std::size_t(z);
                    std::uint64_t sum = 0;
                    for (int k = 0; k < block; ++k) sum = sum * kBase[pass] + row[k];
                    out[(std::size_t(z) * std::size_t(nx) + std::size_t(x)) * std::size_t(ny) +
                        std::size_t(y)] = sum;
                }
        std::swap(in, out);
        nz = ny;
        ny = nx;
        nx = m;
    }
    std::swap(in, out);
}

// Hashes one row of groups along z after the other.
class Hashing {
public:
    Hashing(const BlockIndexData& data, const RunContext& ctx) : mData(data), mContext(ctx) {
        const Index3 size = data.positions.size();
        for (int axis = 0; axis < 3; ++axis) mGroups[axis] = (size[axis] + kGroup - 1) / kGroup;
    }

    // Groups of positions whose blocks are not all constant; what they cost is most of an index.
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
        const std::size_t rows = std::size_t(mGroups.x) * std::size_t(mGroups.y);
        std::vector<std::vector<Hashed>> found(rows);
        parallelFor(mContext, rows, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t row = begin; row < end; ++row) hashRow(row, found[row]);
        });
        std::vector<Hashed> all;
        for (const auto& row : found) all.insert(all.end(), row.begin(), row.end());
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

    void hashRow(std::size_t row, std::vector<Hashed>& found) const {
        const int n = mData.block + kGroup - 1;
        std::vector<float> region(std::size_t(n) * std::size_t(n) * std::size_t(n));
        std::vector<std::uint64_t> hashes;
        // Where in `found` the run of constant blocks of each row of positions is that may still grow.
        std::array<std::size_t, kGroup * kGroup> open;
        open.fill(kNone);
        for (int group = 0; group < mGroups.z; ++group) {
            const Index3 at = corner(row, group);
            float value = 0;
            if (isConstant(at, value)) {
                addConstant(at, constantHash(value, mData.block), open, found);
                continue;
            }
            open.fill(kNone);
            mData.exemplar->readBox(at, {n, n, n}, region.data());
            hashRegion(region, n, mData.block, hashes);
            for (int i = 0; i < kGroup * kGroup * kGroup; ++i) {
                const Index3 p = at + Index3{i / (kGroup * kGroup), i / kGroup % kGroup, i % kGroup};
                if (mData.positions.contains(p) && mData.eligible(p))
                    found.push_back({hashes[std::size_t(i)], {mData.numberOf(p), 1}});
            }
        }
    }

    void addConstant(const Index3& at, std::uint64_t hash, std::array<std::size_t, kGroup * kGroup>& open,
                     std::vector<Hashed>& found) const {
        for (int i = 0; i < kGroup * kGroup * kGroup; ++i) {
            const Index3 p = at + Index3{i / (kGroup * kGroup), i / kGroup % kGroup, i % kGroup};
            if (!mData.positions.contains(p) || !mData.eligible(p)) continue;
            std::size_t& run = open[std::size_t(i / kGroup)];
            const std::uint64_t number = mData.numberOf(p);
            if (run != kNone && found[run].hash == hash &&
                found[run].run.first + found[run].run.length == number) {
                ++found[run].run.length;
                continue;
            }
            run = found.size();
            found.push_back({hash, {number, 1}});
        }
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
