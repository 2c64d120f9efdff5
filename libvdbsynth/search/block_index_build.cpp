// Builds the search tree: pyramid fields, nodes (identical blocks become one by a rolling hash that is then
// verified), groups of neighbouring nodes.
#include "libvdbsynth/search/block_index_data.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kGroup = 4;  // positions a side; 4 measured best of 2, 4, 8 on balls and terrain at 64^3

struct Hashed {
    std::uint64_t hash;
    std::uint64_t position;
};

std::uint64_t mix(float value) {
    std::uint32_t bits = 0;
    if (value != 0.f) std::memcpy(&bits, &value, sizeof bits);  // -0 and +0 are one
    std::uint64_t x = bits + 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

constexpr std::uint64_t kBase[3] = {0x9E3779B97F4A7C15ull, 0xC2B2AE3D27D4EB4Full, 0x165667B19E3779F9ull};

// What hashBlocks gives for a block of one value.
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
void hashBlocks(const std::vector<float>& region, int n, int block, std::vector<std::uint64_t>& out) {
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

std::vector<int> cellsFor(int block) {
    std::vector<int> cells{block / 2};
    // Sixty-four means pay from cubes of 2 on; five hundred and twelve only where the leaf is much larger
    // still.
    if (block / 4 >= 2) cells.push_back(block / 4);
    for (int cell = block / 8; cell >= 4; cell /= 2) cells.push_back(cell);
    return cells;
}

// All eligible blocks with their hashes, group by group.
std::vector<Hashed> hashAll(const BlockIndexData& data, const RunContext& ctx) {
    const Index3 size = data.positions.size();
    const Index3 groups{(size.x + kGroup - 1) / kGroup, (size.y + kGroup - 1) / kGroup,
                        (size.z + kGroup - 1) / kGroup};
    const std::size_t count = std::size_t(groups.x) * std::size_t(groups.y) * std::size_t(groups.z);
    constexpr std::size_t kGrain = 16;
    std::vector<std::vector<Hashed>> chunks((count + kGrain - 1) / kGrain);
    const int n = data.block + kGroup - 1;
    std::vector<float> blank(std::size_t(n) * std::size_t(n) * std::size_t(n));
    parallelFor(ctx, count, kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<float> region(blank.size());
        std::vector<std::uint64_t> hashes;
        for (std::size_t g = begin; g < end; ++g) {
            const Index3 corner{int(g / std::size_t(groups.z) / std::size_t(groups.y)) * kGroup,
                                int(g / std::size_t(groups.z) % std::size_t(groups.y)) * kGroup,
                                int(g % std::size_t(groups.z)) * kGroup};
            float constant = 0;
            const bool isConstant = data.exemplar->constantIn(IndexBox::cube(corner, n), constant);
            if (!isConstant) {
                data.exemplar->readBox(corner, {n, n, n}, region.data());
                hashBlocks(region, n, data.block, hashes);
            }
            for (int i = 0; i < kGroup * kGroup * kGroup; ++i) {
                const Index3 p = corner + Index3{i / (kGroup * kGroup), i / kGroup % kGroup, i % kGroup};
                if (!data.positions.contains(p) || !data.eligible(p)) continue;
                const std::uint64_t hash =
                    isConstant ? constantHash(constant, data.block) : hashes[std::size_t(i)];
                chunks[begin / kGrain].push_back({hash, data.numberOf(p)});
            }
        }
    });
    std::vector<Hashed> all;
    for (const auto& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
    return all;
}

// True if the blocks at a and b have equal samples.
bool sameBlock(const BlockIndexData& data, std::uint64_t a, std::uint64_t b, std::vector<float>& scratch) {
    const int n = data.block;
    float va = 0, vb = 0;
    const Index3 pa = data.positionOf(a), pb = data.positionOf(b);
    if (data.exemplar->constantIn(IndexBox::cube(pa, n), va) &&
        data.exemplar->constantIn(IndexBox::cube(pb, n), vb))
        return va == vb;
    scratch.resize(std::size_t(n) * std::size_t(n) * std::size_t(n));
    data.exemplar->readBox(pa, {n, n, n}, scratch.data());
    const double none = std::numeric_limits<double>::denorm_min();
    return blockCost(*data.exemplar, pb, n, scratch.data(), nullptr, 1, none) == 0;
}

// One node for each set of identical blocks: its first position; the others in (first, member) pairs.
void joinIdentical(const BlockIndexData& data, std::vector<Hashed>& all, std::vector<std::uint64_t>& firsts,
                   std::vector<std::pair<std::uint64_t, std::uint64_t>>& members, const RunContext& ctx) {
    std::sort(all.begin(), all.end(), [](const Hashed& a, const Hashed& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.position < b.position;
    });
    std::vector<std::size_t> runs;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (i == 0 || all[i].hash != all[i - 1].hash) runs.push_back(i);
    runs.push_back(all.size());
    std::vector<char> joins(all.size(), 0);
    parallelFor(ctx, runs.size() - 1, 256, [&](std::size_t begin, std::size_t end) {
        std::vector<float> scratch;
        for (std::size_t r = begin; r < end; ++r)
            for (std::size_t i = runs[r] + 1; i < runs[r + 1]; ++i)
                joins[i] = sameBlock(data, all[runs[r]].position, all[i].position, scratch);
    });
    std::size_t run = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == runs[run + 1]) ++run;
        if (joins[i])
            members.emplace_back(all[runs[run]].position, all[i].position);
        else
            firsts.push_back(all[i].position);
    }
    std::sort(members.begin(), members.end());
}

void makeGroups(BlockIndexData& data, std::vector<std::uint64_t> firsts,
                const std::vector<std::pair<std::uint64_t, std::uint64_t>>& members) {
    const auto groupKey = [&](std::uint64_t number) {
        const Index3 p = data.positionOf(number);
        return data.numberOf({p.x / kGroup * kGroup, p.y / kGroup * kGroup, p.z / kGroup * kGroup});
    };
    std::sort(firsts.begin(), firsts.end(), [&](std::uint64_t a, std::uint64_t b) {
        const std::uint64_t ga = groupKey(a), gb = groupKey(b);
        return ga != gb ? ga < gb : a < b;
    });
    data.nodes = std::move(firsts);
    data.memberBegin.assign(data.nodes.size() + 1, 0);
    const int half = data.cells.front();
    for (std::uint32_t node = 0; node < data.nodes.size(); ++node) {
        data.memberBegin[node] = std::uint32_t(data.members.size());
        const auto range = std::equal_range(members.begin(), members.end(),
                                            std::make_pair(data.nodes[node], std::uint64_t(0)),
                                            [](const auto& a, const auto& b) { return a.first < b.first; });
        for (auto it = range.first; it != range.second; ++it) data.members.push_back(it->second);
        const Index3 p = data.position(node);
        if (node == 0 || groupKey(data.nodes[node]) != groupKey(data.nodes[node - 1])) {
            BlockGroup group;
            group.box = {p, p};
            group.first = node;
            group.low.fill(std::numeric_limits<float>::infinity());
            group.high.fill(-std::numeric_limits<float>::infinity());
            data.groups.push_back(group);
        }
        BlockGroup& group = data.groups.back();
        group.last = node + 1;
        group.shared = group.shared || range.first != range.second;
        for (int axis = 0; axis < 3; ++axis) {
            group.box.min[axis] = std::min(group.box.min[axis], p[axis]);
            group.box.max[axis] = std::max(group.box.max[axis], p[axis]);
        }
        for (std::size_t c = 0; c < 8; ++c) {
            const float mean =
                data.means.front().inside(p + Index3{c & 4 ? half : 0, c & 2 ? half : 0, c & 1 ? half : 0});
            group.low[c] = std::min(group.low[c], mean);
            group.high[c] = std::max(group.high[c], mean);
        }
    }
    data.memberBegin[data.nodes.size()] = std::uint32_t(data.members.size());
}

}  // namespace

bool BlockIndexData::eligible(const Index3& p) const {
    return !maskMeans || maskMeans->inside(p) == 1.f;
}

std::size_t BlockIndexData::memoryBytes() const {
    std::size_t bytes = exemplar->memoryBytes() + groups.size() * sizeof(BlockGroup) +
                        nodes.size() * sizeof(std::uint64_t) + memberBegin.size() * sizeof(std::uint32_t) +
                        members.size() * sizeof(std::uint64_t);
    for (const BrickField& field : means) bytes += field.memoryBytes();
    return bytes;
}

IndexBox blockPositions(const BrickField& exemplar, int block) {
    const Index3 size = exemplar.box().size();
    if (block > size.x || block > size.y || block > size.z)
        throw Error(ErrorCode::Unusable,
                    "--block " + std::to_string(block) + ": larger than the exemplar, which has " +
                        std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
                        std::to_string(size.z) + " voxels; use a smaller block or a finer exemplar");
    return IndexBox::fromSize({size.x - block + 1, size.y - block + 1, size.z - block + 1});
}

bool blockInsideMask(const BrickField& mask, const Index3& corner, int block) {
    std::vector<float> values(std::size_t(block) * std::size_t(block) * std::size_t(block));
    mask.readBox(corner, {block, block, block}, values.data());
    return std::all_of(values.begin(), values.end(), [](float v) { return v == 1.f; });
}

BlockIndexData buildBlockIndexData(std::shared_ptr<const BrickField> exemplar,
                                   const BlockIndexOptions& options, const RunContext& ctx) {
    requireOption(options.block >= 4 && options.block <= 256, "block", std::to_string(options.block),
                  "a whole number from 4 to 256");
    BlockIndexData data;
    data.block = options.block;
    data.positions = blockPositions(*exemplar, options.block);
    data.exemplar = std::move(exemplar);
    if (data.positions.volume() >= std::int64_t(std::numeric_limits<std::uint32_t>::max()))
        throw Error(
            ErrorCode::Memory,
            "the exemplar has over 4 billion block positions; use a smaller --exemplar-box or larger voxels");
    if (options.mask)
        data.maskMeans = std::make_shared<BrickField>(slidingMean(*options.mask, options.block, ctx));
    data.cells = cellsFor(options.block);
    for (int cell : data.cells) data.means.push_back(slidingMean(*data.exemplar, cell, ctx));
    const IndexBox& box = data.exemplar->box();
    std::vector<float> slab(std::size_t(box.size().y) * std::size_t(box.size().z));
    for (int x = 0; x < box.size().x; ++x) {
        data.exemplar->readBox({x, 0, 0}, {1, box.size().y, box.size().z}, slab.data());
        for (float value : slab) data.largest = std::max(data.largest, std::abs(value));
    }
    std::vector<Hashed> all = hashAll(data, ctx);
    if (all.empty())
        throw Error(ErrorCode::Unusable, "--exemplar-mask: no block of " + std::to_string(options.block) +
                                             " voxels fits inside the mask; use a smaller --block");
    std::vector<std::uint64_t> firsts;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> members;
    joinIdentical(data, all, firsts, members, ctx);
    makeGroups(data, std::move(firsts), members);
    return data;
}

}  // namespace vdbsynth
