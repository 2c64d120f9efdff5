#include "libvdbsynth/search/block_index_data.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/search/block_bound.h"
#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

namespace vdbsynth {
namespace {

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

// A node that may still be the best match. Made in place: a pair that is copied right after its halves were
// written stalls, which was a twelfth of a search.
struct Survivor {
    Survivor() = default;
    Survivor(float b, std::uint32_t n) : bound(b), node(n) {}
    float bound = 0;
    std::uint32_t node = 0;
};

// Survivors of one cube, at [begin, end) of all of them; at first they are groups.
struct SurvivingCube {
    float least;  // of their bounds
    std::size_t begin, end;
};

// What a search writes to while it runs; kept for the next one, since getting megabytes from the system for
// every query costs a tenth of it.
struct Scratch {
    CubeBounds cube;
    std::vector<std::pair<float, std::uint32_t>> groups;  // bounds and numbers
    std::vector<Survivor> nodes, survivors, before;
    void clear() {
        groups.clear();
        nodes.clear();
        survivors.clear();
        before.clear();
    }
};

class Search {
public:
    Search(const BlockIndexData& data, const BlockQuery& query, const BlockSearchOptions& options,
           BlockSearchCounts& counts, Scratch& scratch)
        : mData(data),
          mQuery(query),
          mCounts(counts),
          mCube(scratch.cube),
          mGroups(scratch.groups),
          mNodes(scratch.nodes),
          mSurvivors(scratch.survivors),
          mBefore(scratch.before),
          mBest(options.count),
          mSlack(1 / ((1 + options.tolerance) * (1 + options.tolerance))),
          mKnown(countKnown(query.known, data.block)) {
        mCandidates =
            query.candidates.empty() ? data.positions : query.candidates.intersection(data.positions);
        mRestricted = !(mCandidates == data.positions);
        float largest = data.largest;
        for (std::int64_t i = 0; i < std::int64_t(data.block) * data.block * data.block; ++i)
            if (!query.known || query.known[i]) largest = std::max(largest, std::abs(query.samples[i]));
        mMargin = 4e-7f * largest;  // two roundings to float, of a mean here and of one in the pyramid
    }

    // Coarse to fine: what a level leaves is bounded by the next one, cube by cube, those with the least
    // bound first. The node with the least bound so far is compared at once, so that the limit falls early.
    std::vector<BlockMatch> run() {
        if (mCandidates.empty()) return {};
        if (mKnown == 0) return firstPositions();
        // A hint does not win a tie against a smaller position: bounds equal to the limit are still opened.
        for (const Index3& hint : mQuery.hints)
            if (mCandidates.contains(hint) && mData.eligible(hint)) mBest.add({hint, cost(hint)});
        std::vector<SurvivingCube> groups = openGroups();
        for (std::size_t l = 1; l < mData.cells.size(); ++l)
            groups = refine(groups, mData.means[l], mData.cells[l], l < 2 ? kFewNodes : kFewBlocks);
        const auto crowded = [](const SurvivingCube& g) { return g.end - g.begin > kFewBlocks; };
        if (std::any_of(groups.begin(), groups.end(), crowded))
            refine(groups, mData.means.back(), 1, kFewBlocks);
        compareSurvivors();
        return mBest.take();
    }

private:
    // Exact: a bound equal to the limit is still followed, the tie goes by position.
    double pruneAbove() const { return mBest.limit() * mSlack; }

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

    std::vector<SurvivingCube> openGroups() {
        const QueryLevel level = queryLevel(mQuery, mData.block, mData.cells.front(), mKnown);
        const LevelBound bounds(level, mMargin);
        std::vector<SurvivingCube> all = boundGroups(level, bounds), opened;
        probe(all, bounds);
        for (SurvivingCube& cube : all) {
            if (double(cube.least) > pruneAbove()) break;
            gather(cube);
            boundNodes(bounds, mData.means.front(), kFewNodes, cube);
            if (cube.begin != cube.end) opened.push_back(cube);
        }
        return opened;
    }

    // Cubes with the groups in them that may hold the answer, those with the least bound first.
    std::vector<SurvivingCube> boundGroups(const QueryLevel& level, const LevelBound& bounds) {
        std::vector<SurvivingCube> cubes;
        std::array<float, 8> mean{}, known{};
        for (std::size_t i = 0; i < level.mean.size(); ++i) {
            const Index3& o = level.offset[i];
            const std::size_t cell = std::size_t((o.x ? 4 : 0) + (o.y ? 2 : 0) + (o.z ? 1 : 0));
            mean[cell] = level.mean[i];
            known[cell] = 1;
        }
        const float limit = bounds.squaresFor(pruneAbove());
        Index3 last{-1, -1, -1};
        for (std::uint32_t g = 0; g < mData.groups.size(); ++g) {
            const BlockGroup& group = mData.groups[g];
            if (mRestricted && !group.shared && group.box.intersection(mCandidates).empty()) continue;
            const float squares = squaresBeyond(group, mean, known);
            if (squares > limit) continue;
            const float bound = bounds.from(squares);
            const Index3 corner = cubeCorner(group.box.min);
            if (!(corner == last)) cubes.push_back({bound, mGroups.size(), 0});
            last = corner;
            mGroups.emplace_back(bound, g);
            cubes.back().least = std::min(cubes.back().least, bound);
            cubes.back().end = mGroups.size();
        }
        sortCubes(cubes);
        return cubes;
    }

    // Follows the cubes with the least bounds all the way down, for a limit that leaves little to do.
    void probe(const std::vector<SurvivingCube>& cubes, const LevelBound& coarsest) {
        std::vector<SurvivingCube> few;
        for (std::size_t i = 0; i < std::min(cubes.size(), kProbedCubes); ++i) {
            few.push_back(cubes[i]);
            gather(few.back());
            boundNodes(coarsest, mData.means.front(), kFewNodes, few.back());
        }
        for (std::size_t l = 1; l < mData.cells.size(); ++l)
            few = refine(few, mData.means[l], mData.cells[l], l < 2 ? kFewNodes : kFewBlocks);
        std::partial_sort(mSurvivors.begin(),
                          mSurvivors.begin() + std::ptrdiff_t(std::min(mSurvivors.size(), kProbedNodes)),
                          mSurvivors.end(), lessBound);
        mSurvivors.resize(std::min(mSurvivors.size(), kProbedNodes));
        compareSurvivors();
        mSurvivors.clear();
        mLeast = std::numeric_limits<float>::infinity();
    }

    // The nodes of a cube's groups that may be the answer.
    void gather(const SurvivingCube& cube) {
        mNodes.clear();
        for (std::size_t i = cube.begin; i < cube.end; ++i) {
            const auto& [bound, group] = mGroups[i];
            if (double(bound) > pruneAbove()) continue;
            ++mCounts.groups;
            const BlockGroup& of = mData.groups[group];
            for (std::uint32_t node = of.first; node < of.last; ++node)
                if (!mRestricted || mData.isShared(node) || mCandidates.contains(mData.position(node)))
                    mNodes.emplace_back(bound, node);
        }
    }

    // How far the query's eight means lie beyond the group's ranges; of means that are not known, nothing.
    static float squaresBeyond(const BlockGroup& group, const std::array<float, 8>& mean,
                               const std::array<float, 8>& known) {
        float squares[8], sum = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            const float outside = std::max(group.low[k] - mean[k], mean[k] - group.high[k]);
            const float beyond = std::max(outside, 0.f) * known[k];
            squares[k] = beyond * beyond;
        }
        for (float square : squares) sum += square;
        return sum;
    }

    // Bounds the nodes in mNodes that are still worth it, and keeps as survivors those that stay so.
    void boundNodes(const LevelBound& level, const LevelField& field, std::size_t few, SurvivingCube& cube) {
        cube.begin = mSurvivors.size();
        cube.least = std::numeric_limits<float>::infinity();
        const float limit = level.squaresFor(pruneAbove());
        mCounts.nodes += mNodes.size();
        Survivor best{std::numeric_limits<float>::infinity(), 0};
        const auto keep = [&](const Survivor& node, float squares) {
            if (squares > limit) return;
            const float bound = std::max(node.bound, level.from(squares));
            mSurvivors.emplace_back(bound, node.node);
            if (bound < best.bound) best = mSurvivors.back();
        };
        if (mNodes.size() > few) {
            const Index3 corner = cubeCorner(mData.position(mNodes.front().node));
            const std::vector<float>& sums = mCube.bound(level, field, corner, limit);
            for (const Survivor& node : mNodes) keep(node, sums[mData.places[node.node]]);
        } else {
            for (const Survivor& node : mNodes)
                keep(node, level.ofNode(field, mData.position(node.node), limit));
        }
        cube.end = mSurvivors.size();
        cube.least = best.bound;
        if (best.bound < mLeast) {
            mLeast = best.bound;
            evaluate(best.node);
        }
    }

    // Sums over the samples themselves bound nothing that a comparison would not tell: few are left for that.
    std::vector<SurvivingCube> refine(std::vector<SurvivingCube> cubes, const LevelField& field, int cell,
                                      std::size_t few) {
        const QueryLevel level = queryLevel(mQuery, mData.block, cell, mKnown);
        const LevelBound bounds(level, mMargin);
        std::swap(mBefore, mSurvivors);
        mSurvivors.clear();
        mLeast = std::numeric_limits<float>::infinity();
        sortCubes(cubes);
        std::vector<SurvivingCube> left;
        for (SurvivingCube& cube : cubes) {
            if (double(cube.least) > pruneAbove()) break;
            mNodes.clear();
            for (std::size_t i = cube.begin; i < cube.end; ++i)
                if (double(mBefore[i].bound) <= pruneAbove()) mNodes.push_back(mBefore[i]);
            if (cell < mData.block / 4 && mNodes.size() <= few) {
                cube.begin = mSurvivors.size();
                mSurvivors.insert(mSurvivors.end(), mNodes.begin(), mNodes.end());
                cube.end = mSurvivors.size();
            } else {
                boundNodes(bounds, field, few, cube);
            }
            if (cube.begin != cube.end) left.push_back(cube);
        }
        return left;
    }

    void compareSurvivors() {
        std::sort(mSurvivors.begin(), mSurvivors.end(), lessBound);
        for (const Survivor& survivor : mSurvivors) {
            if (double(survivor.bound) > pruneAbove()) break;
            evaluate(survivor.node);
        }
    }

    static bool lessBound(const Survivor& a, const Survivor& b) {
        return a.bound != b.bound ? a.bound < b.bound : a.node < b.node;
    }

    static void sortCubes(std::vector<SurvivingCube>& groups) {
        std::sort(groups.begin(), groups.end(), [](const SurvivingCube& a, const SurvivingCube& b) {
            return a.least != b.least ? a.least < b.least : a.begin < b.begin;
        });
    }

    void evaluate(std::uint32_t node) { addMembers(node, cost(mData.position(node))); }

    void addMembers(std::uint32_t node, double value) {
        if (value > mBest.limit()) return;
        mData.forMembers(node, mCandidates, [&](const Index3& position) {
            return mBest.add({position, value});
        });
    }

    static constexpr std::size_t kProbedCubes = 8, kProbedNodes = 8;
    // Up to so many nodes of a cube are bounded one by one.
    static constexpr std::size_t kFewNodes = 48, kFewBlocks = 64;

    const BlockIndexData& mData;
    const BlockQuery& mQuery;
    BlockSearchCounts& mCounts;
    CubeBounds& mCube;
    std::vector<std::pair<float, std::uint32_t>>& mGroups;
    std::vector<Survivor>&mNodes, &mSurvivors, &mBefore;
    Best mBest;
    double mSlack;  // a bound is worth following up to this share of the limit
    std::int64_t mKnown;
    IndexBox mCandidates;
    bool mRestricted = false;
    float mMargin = 0;
    float mLeast = std::numeric_limits<float>::infinity();
};

}  // namespace

struct BlockIndex::Impl {
    BlockIndexData data;
    std::mutex mutex;
    std::vector<std::unique_ptr<Scratch>> idle;  // one for every call that ran at the same time

    std::unique_ptr<Scratch> takeScratch() {
        const std::lock_guard<std::mutex> lock(mutex);
        if (idle.empty()) return std::make_unique<Scratch>();
        std::unique_ptr<Scratch> scratch = std::move(idle.back());
        idle.pop_back();
        return scratch;
    }
    void giveBack(std::unique_ptr<Scratch> scratch) {
        scratch->clear();
        const std::lock_guard<std::mutex> lock(mutex);
        idle.push_back(std::move(scratch));
    }
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

std::vector<BlockMatch> BlockIndex::match(const BlockQuery& query, const BlockSearchOptions& options,
                                          BlockSearchCounts* counts) const {
    requireOption(options.count >= 1, "count", std::to_string(options.count), "at least 1");
    requireOption(options.tolerance >= 0 && options.tolerance <= 100, "tolerance",
                  std::to_string(options.tolerance), "from 0 to 100");
    BlockSearchCounts ignored;
    std::unique_ptr<Scratch> scratch = mImpl->takeScratch();
    std::vector<BlockMatch> found =
        Search(mImpl->data, query, options, counts ? *counts : ignored, *scratch).run();
    mImpl->giveBack(std::move(scratch));
    return found;
}

std::vector<BlockMatch> BlockIndex::match(const BlockQuery& query, int count,
                                          BlockSearchCounts* counts) const {
    BlockSearchOptions options;
    options.count = count;
    return match(query, options, counts);
}

std::vector<std::vector<BlockMatch>> BlockIndex::matchAll(const std::vector<BlockQuery>& queries,
                                                          const BlockSearchOptions& options,
                                                          const RunContext& ctx,
                                                          BlockSearchCounts* counts) const {
    constexpr std::size_t kTogether = 8;
    std::vector<std::vector<BlockMatch>> found(queries.size());
    std::vector<BlockSearchCounts> done((queries.size() + kTogether - 1) / kTogether);
    parallelFor(ctx, queries.size(), kTogether, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            BlockQuery query = queries[i];
            if (i > begin)
                for (const BlockMatch& match : found[i - 1]) query.hints.push_back(match.position);
            found[i] = match(query, options, &done[begin / kTogether]);
        }
    });
    for (const BlockSearchCounts& part : done)
        if (counts) {
            counts->groups += part.groups;
            counts->nodes += part.nodes;
            counts->exact += part.exact;
        }
    return found;
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
