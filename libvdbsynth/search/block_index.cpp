#include "libvdbsynth/search/block_index_data.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace vdbsynth {
namespace {

// What the search keeps in its queue. Level 0 is a group, level l > 0 a node bounded by means level l - 1.
struct Entry {
    double bound;
    std::uint32_t id;
    std::uint32_t level;
};

bool laterInQueue(const Entry& a, const Entry& b) {
    if (a.bound != b.bound) return a.bound > b.bound;
    if (a.level != b.level) return a.level < b.level;
    return a.id > b.id;
}

bool betterMatch(const BlockMatch& a, const BlockMatch& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.position < b.position;
}

// The K best so far, best first.
class Best {
public:
    explicit Best(int count) : mCount(std::size_t(count)) {}
    // What a bound must not exceed to be worth opening. Equal costs still count: the tie goes by position.
    double limit() const {
        return mMatches.size() < mCount ? std::numeric_limits<double>::infinity() : mMatches.back().cost;
    }
    // False if the match was not good enough, and so none of the same cost at a later position is.
    bool add(const BlockMatch& match) {
        if (mMatches.size() == mCount && betterMatch(mMatches.back(), match)) return false;
        const auto place = std::lower_bound(mMatches.begin(), mMatches.end(), match, betterMatch);
        if (place != mMatches.end() && place->position == match.position && place->cost == match.cost)
            return true;
        mMatches.insert(place, match);
        if (mMatches.size() > mCount) mMatches.pop_back();
        return true;
    }
    std::vector<BlockMatch> take() { return std::move(mMatches); }

private:
    std::size_t mCount;
    std::vector<BlockMatch> mMatches;
};

// The query's means at one level, and which of them are wholly known.
struct QueryLevel {
    std::vector<float> mean;
    std::vector<Index3> offset;
    double weight = 0;  // samples in a cube over known samples
};

QueryLevel queryLevel(const BlockQuery& query, int block, int cell, std::int64_t known) {
    QueryLevel level;
    level.weight = double(cell) * cell * cell / double(known);
    const int perSide = block / cell;
    for (int x = 0; x < perSide; ++x)
        for (int y = 0; y < perSide; ++y)
            for (int z = 0; z < perSide; ++z) {
                double sum = 0;
                bool whole = true;
                for (int i = 0; i < cell && whole; ++i)
                    for (int j = 0; j < cell && whole; ++j) {
                        const std::size_t row =
                            (std::size_t(x * cell + i) * std::size_t(block) + std::size_t(y * cell + j)) *
                                std::size_t(block) +
                            std::size_t(z * cell);
                        for (int k = 0; k < cell; ++k) {
                            if (query.known && !query.known[row + std::size_t(k)]) {
                                whole = false;
                                break;
                            }
                            sum += double(query.samples[row + std::size_t(k)]);
                        }
                    }
                if (!whole) continue;
                level.mean.push_back(float(sum / (double(cell) * cell * cell)));
                level.offset.push_back({x * cell, y * cell, z * cell});
            }
    return level;
}

class Search {
public:
    Search(const BlockIndexData& data, const BlockQuery& query, int count, BlockSearchCounts& counts)
        : mData(data),
          mQuery(query),
          mCounts(counts),
          mBest(count),
          mKnown(countKnown(query.known, data.block)) {
        mCandidates =
            query.candidates.empty() ? data.positions : query.candidates.intersection(data.positions);
        mRestricted = !(mCandidates == data.positions);
        float largest = data.largest;
        for (std::int64_t i = 0; i < std::int64_t(data.block) * data.block * data.block; ++i)
            if (!query.known || query.known[i]) largest = std::max(largest, std::abs(query.samples[i]));
        mMargin = 4e-7f * largest;  // two roundings to float, of a mean here and of one in the pyramid
    }

    std::vector<BlockMatch> run() {
        if (mCandidates.empty()) return {};
        if (mKnown == 0) return firstPositions();
        for (int cell : mData.cells) mLevels.push_back(queryLevel(mQuery, mData.block, cell, mKnown));
        for (const Index3& hint : mQuery.hints)
            if (mCandidates.contains(hint) && mData.eligible(hint)) mBest.add({hint, cost(hint)});
        // A hint does not win a tie against a smaller position: bounds equal to the limit are still opened.
        enqueueGroups();
        while (!mQueue.empty()) {
            const Entry front = mQueue.front();
            if (front.bound > mBest.limit()) break;
            std::pop_heap(mQueue.begin(), mQueue.end(), laterInQueue);
            mQueue.pop_back();
            if (front.level == 0)
                openGroup(front.id);
            else if (front.level < mLevels.size())
                push(front.id, front.level + 1);
            else
                evaluate(front.id);
        }
        return mBest.take();
    }

private:
    double cost(const Index3& position) {
        ++mCounts.exact;
        return blockCost(*mData.exemplar, position, mData.block, mQuery.samples, mQuery.known, mKnown,
                         mBest.limit());
    }

    // Every block costs 0: the first eligible positions, by order.
    std::vector<BlockMatch> firstPositions() {
        for (std::uint32_t node = 0; node < mData.nodeCount(); ++node) addMembers(node, 0.0);
        return mBest.take();
    }

    void enqueueGroups() {
        const QueryLevel& level = mLevels.front();
        for (std::uint32_t g = 0; g < mData.groups.size(); ++g) {
            const BlockGroup& group = mData.groups[g];
            if (mRestricted && !group.shared && group.box.intersection(mCandidates).empty()) continue;
            double bound = 0;
            for (std::size_t i = 0; i < level.mean.size(); ++i) {
                const std::size_t cell = cellNumber(level.offset[i]);
                const float below = group.low[cell] - level.mean[i] - mMargin,
                            above = level.mean[i] - group.high[cell] - mMargin;
                const double d = double(std::max({below, above, 0.f}));
                bound += d * d;
            }
            bound *= level.weight * kBoundSafety;
            if (bound <= mBest.limit()) mQueue.push_back({bound, g, 0});
        }
        std::make_heap(mQueue.begin(), mQueue.end(), laterInQueue);
    }

    std::size_t cellNumber(const Index3& offset) const {
        return std::size_t((offset.x ? 4 : 0) + (offset.y ? 2 : 0) + (offset.z ? 1 : 0));
    }

    void openGroup(std::uint32_t g) {
        ++mCounts.groups;
        const BlockGroup& group = mData.groups[g];
        for (std::uint32_t node = group.first; node < group.last; ++node) {
            if (mRestricted && !mData.isShared(node) && !mCandidates.contains(mData.position(node))) continue;
            push(node, 1);
        }
    }

    void push(std::uint32_t node, std::uint32_t level) {
        ++mCounts.nodes;
        const QueryLevel& means = mLevels[level - 1];
        const BrickField& field = mData.means[level - 1];
        const Index3 corner = mData.position(node);
        double bound = 0;
        for (std::size_t i = 0; i < means.mean.size(); ++i) {
            const float d =
                std::max(std::abs(field.inside(corner + means.offset[i]) - means.mean[i]) - mMargin, 0.f);
            bound += double(d) * double(d);
        }
        bound *= means.weight * kBoundSafety;
        if (bound > mBest.limit()) return;
        mQueue.push_back({bound, node, level});
        std::push_heap(mQueue.begin(), mQueue.end(), laterInQueue);
    }

    void evaluate(std::uint32_t node) { addMembers(node, cost(mData.position(node))); }

    void addMembers(std::uint32_t node, double value) {
        if (value > mBest.limit()) return;
        mData.forMembers(node, mCandidates, [&](const Index3& position) {
            return mBest.add({position, value});
        });
    }

    // Sums of squares of floats against sums of rounded floats: relative error below 1e-6.
    static constexpr double kBoundSafety = 1 - 2e-6;

    const BlockIndexData& mData;
    const BlockQuery& mQuery;
    BlockSearchCounts& mCounts;
    Best mBest;
    std::int64_t mKnown;
    IndexBox mCandidates;
    bool mRestricted = false;
    float mMargin = 0;
    std::vector<QueryLevel> mLevels;
    std::vector<Entry> mQueue;
};

}  // namespace

struct BlockIndex::Impl {
    BlockIndexData data;
};

BlockIndex::BlockIndex(std::unique_ptr<Impl> impl) : mImpl(std::move(impl)) {}
BlockIndex::BlockIndex(BlockIndex&&) noexcept = default;
BlockIndex& BlockIndex::operator=(BlockIndex&&) noexcept = default;
BlockIndex::~BlockIndex() = default;

BlockIndex BlockIndex::build(std::shared_ptr<const BrickField> exemplar, const BlockIndexOptions& options,
                             const RunContext& ctx) {
    auto impl = std::make_unique<Impl>();
    impl->data = buildBlockIndexData(std::move(exemplar), options, ctx);
    return BlockIndex(std::move(impl));
}

std::vector<BlockMatch> BlockIndex::match(const BlockQuery& query, int count,
                                          BlockSearchCounts* counts) const {
    requireOption(count >= 1, "count", std::to_string(count), "at least 1");
    BlockSearchCounts ignored;
    return Search(mImpl->data, query, count, counts ? *counts : ignored).run();
}

int BlockIndex::block() const {
    return mImpl->data.block;
}
const BrickField& BlockIndex::exemplar() const {
    return *mImpl->data.exemplar;
}
const IndexBox& BlockIndex::positions() const {
    return mImpl->data.positions;
}
std::size_t BlockIndex::memoryBytes() const {
    return mImpl->data.memoryBytes();
}
std::size_t BlockIndex::nodeCount() const {
    return mImpl->data.nodeCount();
}

std::vector<BlockMatch> matchBlocksLinearly(const BrickField& exemplar, int block, const BlockQuery& query,
                                            int count, const BrickField* mask) {
    const IndexBox positions = blockPositions(exemplar, block);
    const IndexBox box = query.candidates.empty() ? positions : query.candidates.intersection(positions);
    const std::int64_t known = countKnown(query.known, block);
    Best best(count);
    for (int x = box.min.x; x <= box.max.x; ++x)
        for (int y = box.min.y; y <= box.max.y; ++y)
            for (int z = box.min.z; z <= box.max.z; ++z) {
                const Index3 p{x, y, z};
                if (mask && !blockInsideMask(*mask, p, block)) continue;
                best.add({p, known == 0 ? 0.0
                                        : blockCost(exemplar, p, block, query.samples, query.known, known,
                                                    best.limit())});
            }
    return best.take();
}

}  // namespace vdbsynth
