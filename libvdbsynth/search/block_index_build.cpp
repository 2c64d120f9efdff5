// Builds the search tree: pyramid fields, nodes (blocks with equal hashes are merged after a comparison),
// groups of neighbouring nodes.
#include "libvdbsynth/search/block_index_data.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/search/block_cost.h"
#include "libvdbsynth/search/block_hash.h"
#include "libvdbsynth/search/block_index_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kGroup = kNodeGroup;

std::vector<int> cellsFor(int block) {
    std::vector<int> cells{block / 2};
    // Sixty-four means pay off from cubes of 2 on; five hundred and twelve only if the
    // leaf is much larger still.
    if (block / 4 >= 2) cells.push_back(block / 4);
    for (int cell = block / 8; cell >= 2; cell /= 2) cells.push_back(cell);
    return cells;
}

// True if the blocks at a and b have equal samples.
bool sameBlock(const BlockIndexData& data, std::uint64_t a, std::uint64_t b, std::vector<float>& scratch) {
    const int n = data.block;
    float va = 0, vb = 0;
    const Index3 pa = data.positionOf(a), pb = data.positionOf(b);
    if (data.exemplar->constantIn(IndexBox::cube(pa, n), va) &&
        data.exemplar->constantIn(IndexBox::cube(pb, n), vb))
        return va == vb;
    scratch.resize(latticeCount({n, n, n}));
    data.exemplar->readBox(pa, {n, n, n}, scratch.data());
    const double none = std::numeric_limits<double>::denorm_min();
    return blockCost(*data.exemplar, pb, n, scratch.data(), nullptr, 1, none) == 0;
}

// Further positions of a node, which is identified by its first.
struct Member {
    std::uint64_t node;
    PositionRun run;
};

// One node for each set of identical blocks: its first position, with the others as members in order.
void joinIdentical(const BlockIndexData& data, std::vector<Hashed>& all, std::vector<std::uint64_t>& firsts,
                   std::vector<Member>& members, const RunContext& ctx) {
    parallelSort(ctx, all, [](const Hashed& a, const Hashed& b) {
        return a.hash != b.hash ? a.hash < b.hash : a.run.first < b.run.first;
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
                joins[i] = sameBlock(data, all[runs[r]].run.first, all[i].run.first, scratch);
    });
    std::size_t run = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (i == runs[run + 1]) ++run;
        PositionRun rest = all[i].run;
        const std::uint64_t node = joins[i] ? all[runs[run]].run.first : rest.first;
        if (!joins[i]) {
            firsts.push_back(node);
            ++rest.first;
            --rest.length;
        }
        if (rest.length > 0) members.push_back({node, rest});
    }
    parallelSort(ctx, members, [](const Member& a, const Member& b) {
        return a.node != b.node ? a.node < b.node : a.run.first < b.run.first;
    });
}

// Orders positions by cube, group, place in the group, all lexicographically.
class NodeOrder {
public:
    explicit NodeOrder(const BlockIndexData& data) {
        for (int axis = 0; axis < 3; ++axis)
            mCubes[axis] = (data.positions.size()[axis] + kNodeCube - 1) / kNodeCube;
    }
    std::uint64_t key(const Index3& p) const {
        const std::uint64_t cube = latticeIndex({p.x / kNodeCube, p.y / kNodeCube, p.z / kNodeCube}, mCubes);
        const Index3 g{p.x / kGroup % 2, p.y / kGroup % 2, p.z / kGroup % 2},
            in{p.x % kGroup, p.y % kGroup, p.z % kGroup};
        return (cube * 8 + std::uint64_t(g.x * 4 + g.y * 2 + g.z)) * kInGroup +
               std::uint64_t((in.x * kGroup + in.y) * kGroup + in.z);
    }
    Index3 position(std::uint64_t key) const {
        const int in = int(key % kInGroup), g = int(key / kInGroup % 8);
        const std::uint64_t cube = key / kInGroup / 8;
        return latticeVoxel(cube, mCubes) * kNodeCube + Index3{g / 4, g / 2 % 2, g % 2} * kGroup +
               Index3{in / kGroup / kGroup, in / kGroup % kGroup, in % kGroup};
    }
    static std::uint64_t group(std::uint64_t key) { return key / kInGroup; }

private:
    static_assert(kNodeCube == 2 * kGroup);
    static constexpr std::uint64_t kInGroup = kGroup * kGroup * kGroup;
    Index3 mCubes;
};

// Nodes in order, and the boundaries of groups.
void orderNodes(BlockIndexData& data, std::vector<std::uint64_t> firsts, const RunContext& ctx) {
    const NodeOrder order(data);
    const auto each = [&](auto&& work) {
        parallelFor(ctx, firsts.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) work(i);
        });
    };
    each([&](std::size_t i) { firsts[i] = order.key(data.positionOf(firsts[i])); });
    parallelSort(ctx, firsts);
    for (std::uint32_t node = 0; node < firsts.size(); ++node)
        if (node == 0 || order.group(firsts[node]) != order.group(firsts[node - 1])) {
            if (node > 0) data.groups.back().last = node;
            data.groups.emplace_back().first = node;
        }
    data.groups.back().last = std::uint32_t(firsts.size());
    data.places.resize(firsts.size());
    data.nodes.resize(firsts.size());
    each([&](std::size_t i) {
        const Index3 p = order.position(firsts[i]);
        data.places[i] = std::uint16_t(placeInCube(p));
        data.nodes[i] = data.numberOf(p);
    });
}

void orderMembers(BlockIndexData& data, const std::vector<Member>& members) {
    data.memberBegin.assign(data.nodes.size() + 1, 0);
    if (members.empty()) return;
    data.members.reserve(members.size());
    for (std::uint32_t node = 0; node < data.nodes.size(); ++node) {
        data.memberBegin[node] = std::uint32_t(data.members.size());
        const std::uint64_t key = data.nodes[node];
        auto member = std::partition_point(members.begin(), members.end(),
                                           [key](const Member& m) { return m.node < key; });
        for (; member != members.end() && member->node == key; ++member) data.members.push_back(member->run);
    }
    data.memberBegin[data.nodes.size()] = std::uint32_t(data.members.size());
}

// Box of a group's nodes and the ranges of their means.
void boundGroup(const BlockIndexData& data, BlockGroup& group) {
    const int half = data.cells.front();
    group.low.fill(std::numeric_limits<float>::infinity());
    group.high.fill(-std::numeric_limits<float>::infinity());
    const Index3 first = data.position(group.first);
    group.box = {first, first};
    for (std::uint32_t node = group.first; node < group.last; ++node) {
        const Index3 p = data.position(node);
        group.shared = group.shared || data.isShared(node);
        for (int axis = 0; axis < 3; ++axis) {
            group.box.min[axis] = std::min(group.box.min[axis], p[axis]);
            group.box.max[axis] = std::max(group.box.max[axis], p[axis]);
        }
        for (std::size_t c = 0; c < 8; ++c) {
            const float mean =
                data.means.front().at(p + Index3{c & 4 ? half : 0, c & 2 ? half : 0, c & 1 ? half : 0});
            group.low[c] = std::min(group.low[c], mean);
            group.high[c] = std::max(group.high[c], mean);
        }
    }
}

void makeGroups(BlockIndexData& data, std::vector<std::uint64_t> firsts, const std::vector<Member>& members,
                const RunContext& ctx) {
    orderNodes(data, std::move(firsts), ctx);
    orderMembers(data, members);
    parallelFor(ctx, data.groups.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t g = begin; g < end; ++g) boundGroup(data, data.groups[g]);
    });
}

}  // namespace

bool BlockIndexData::eligible(const Index3& p) const {
    return !maskMeans || maskMeans->inside(p) == 1.f;
}

double BlockIndexData::cost(const Index3& position, const BlockQuery& query, std::int64_t known,
                            double giveUp) const {
    const DenseField& dense = means.back().dense;
    return dense.samples.empty()
               ? blockCost(*exemplar, position, block, query.samples, query.known, known, giveUp)
               : blockCost(dense, position, block, query.samples, query.known, known, giveUp);
}

std::size_t BlockIndexData::memoryBytes() const {
    std::size_t bytes = exemplar->memoryBytes() + groups.size() * sizeof(BlockGroup) +
                        nodes.size() * (sizeof(std::uint64_t) + sizeof(std::uint16_t)) +
                        memberBegin.size() * sizeof(std::uint32_t) + members.size() * sizeof(PositionRun);
    for (const LevelField& field : means) bytes += field.memoryBytes();
    return bytes;
}

IndexBox blockPositions(const BrickField& exemplar, int block) {
    const Index3 size = exemplar.box().size();
    if (block > size.x || block > size.y || block > size.z)
        throw Error(ErrorCode::Unusable,
                    "`block` " + std::to_string(block) + ": larger than the exemplar, which has " +
                        std::to_string(size.x) + " x " + std::to_string(size.y) + " x " +
                        std::to_string(size.z) + " voxels; use a smaller block or a finer exemplar");
    return IndexBox::fromSize({size.x - block + 1, size.y - block + 1, size.z - block + 1});
}

bool blockInsideMask(const BrickField& mask, const Index3& corner, int block) {
    std::vector<float> values(latticeCount({block, block, block}));
    mask.readBox(corner, {block, block, block}, values.data());
    return std::all_of(values.begin(), values.end(), [](float v) { return v == 1.f; });
}

namespace {

void makeDense(LevelField& field, const RunContext& ctx) {
    const Index3 beyond{kNodeCube, kNodeCube, kNodeCube};
    field.dense.size = field.bricks->box().size() + beyond;
    const std::size_t plane = std::size_t(field.dense.size.y) * std::size_t(field.dense.size.z);
    field.dense.samples.resize(std::size_t(field.dense.size.x) * plane);
    parallelFor(ctx, std::size_t(field.dense.size.x), 4, [&](std::size_t begin, std::size_t end) {
        field.bricks->readBox({int(begin), 0, 0}, {int(end - begin), field.dense.size.y, field.dense.size.z},
                              field.dense.samples.data() + begin * plane);
    });
    field.bricks.reset();
}

// A damaged cached index is rebuilt, with a warning.
bool readKept(const std::string& path, BlockIndexData& data, const RunContext& ctx) {
    try {
        const bool found = readBlockIndex(path, data);
        message(ctx, MessageLevel::Detail,
                found ? "index read from " + path : "index will be saved as " + path);
        return found;
    } catch (const Error& error) {
        if (error.code() != ErrorCode::BadData) throw;
        message(ctx, MessageLevel::Warning, std::string(error.what()) + "; it is rebuilt");
        return false;
    }
}

// Fine to coarse: a level is computed from the finer one if its cells are twice as large.
void makeMeans(BlockIndexData& data, const RunContext& ctx) {
    data.means.resize(data.cells.size() + 1);
    data.means.back().bricks = data.exemplar;
    for (std::size_t l = data.cells.size(); l-- > 0;) {
        const bool twice = l + 1 < data.cells.size() && data.cells[l] == 2 * data.cells[l + 1];
        data.means[l].bricks = std::make_shared<const BrickField>(
            twice ? twiceSlidingMean(*data.means[l + 1].bricks, data.cells[l + 1], ctx)
                  : slidingMean(*data.exemplar, data.cells[l], ctx));
    }
}

void makeNodes(BlockIndexData& data, const RunContext& ctx) {
    std::vector<Hashed> all = hashBlocks(data, ctx);
    if (all.empty())
        throw Error(ErrorCode::Unusable, "`exemplarMask`: no block of " + std::to_string(data.block) +
                                             " voxels fits inside the mask; use a smaller `block`");
    std::vector<std::uint64_t> firsts;
    std::vector<Member> members;
    joinIdentical(data, all, firsts, members, ctx);
    makeGroups(data, std::move(firsts), members, ctx);
}

}  // namespace

BlockIndexData buildBlockIndexData(std::shared_ptr<const BrickField> exemplar,
                                   const BlockIndexOptions& options, const RunContext& ctx) {
    validate(options, exemplar.get());
    BlockIndexData data;
    data.block = options.block;
    data.positions = blockPositions(*exemplar, options.block);
    data.exemplar = std::move(exemplar);
    if (data.positions.volume() >= std::int64_t(std::numeric_limits<std::uint32_t>::max()))
        throw Error(
            ErrorCode::Memory,
            "the exemplar has over 4 billion block positions; use a smaller `exemplarBox` or larger voxels");
    if (options.mask)
        data.maskMeans = std::make_shared<BrickField>(slidingMean(*options.mask, options.block, ctx));
    data.cells = cellsFor(options.block);
    const IndexBox& box = data.exemplar->box();
    std::vector<float> slab(std::size_t(box.size().y) * std::size_t(box.size().z));
    for (int x = 0; x < box.size().x; ++x) {
        data.exemplar->readBox({x, 0, 0}, {1, box.size().y, box.size().z}, slab.data());
        for (float value : slab) data.largest = std::max(data.largest, std::abs(value));
    }
    const std::size_t varied = countVariedGroups(data, ctx);
    // A varied position costs a node, twice its hash during sorting, and a sample of each mean.
    requireMemory(ctx,
                  double(varied) * kPositionGroup * kPositionGroup * kPositionGroup *
                      (64 + 4 * double(data.cells.size())),
                  "the search index", "use a smaller `exemplarBox` or larger voxels");
    makeMeans(data, ctx);
    const bool dense =
        double(varied) * kPositionGroup * kPositionGroup * kPositionGroup > 0.7 * double(box.volume());
    for (LevelField& field : data.means)
        if (dense) makeDense(field, ctx);
    const std::string kept = options.cacheFolder.empty()
                                 ? ""
                                 : options.cacheFolder + "/" +
                                       blockIndexFileName(*data.exemplar, options.mask, options.block, ctx);
    if (!kept.empty() && readKept(kept, data, ctx)) return data;
    makeNodes(data, ctx);
    if (!kept.empty()) writeBlockIndex(kept, data);
    return data;
}

}  // namespace vdbsynth
