#include "libvdbsynth/search/block_search.h"

#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

// Survivors of one cube, at [begin, end) of all of them; at first they are groups.
struct SurvivingCube {
    float least;  // of their bounds
    std::size_t begin, end;
};

// Invariants:
// - every position of mCandidates is in mBest, or was excluded by a bound above pruneAbove() at that time (a
// limit
//   only falls, so it stays excluded), or belongs to a group or node that is still to be opened;
// - mGroups holds groups with their bounds, cube by cube; mNodes the nodes of the cube that is being opened;
//   mSurvivors the nodes that the present level left, cube by cube, mBefore those of the level before;
// - bounds never exceed the exact cost (mMargin covers roundings), so the answer is exact for any order;
// - mWork counts comparisons; above mMostWork the search is given up and its partial answer is not used.
class BoundedSearch {
public:
    BoundedSearch(const BlockIndexData& data, const BlockQuery& query, const BlockSearchOptions& options,
                  double mostWork, BlockSearchCounts& counts, BlockSearchScratch& scratch)
        : mData(data),
          mQuery(query),
          mCounts(counts),
          mCube(scratch.cube),
          mGroups(scratch.groups),
          mNodes(scratch.nodes),
          mSurvivors(scratch.survivors),
          mBefore(scratch.before),
          mBest(options.count),
          mMostWork(mostWork),
          mPruneShare(1 / ((1 + options.tolerance) * (1 + options.tolerance))),
          mKnown(countKnown(query.known, data.block)) {
        scratch.groups.clear();
        mNodes.clear();
        mSurvivors.clear();
        mBefore.clear();
        mCandidates =
            query.candidates.empty() ? data.positions : query.candidates.intersection(data.positions);
        mRestricted = !(mCandidates == data.positions);
        float largest = data.largest;
        for (std::int64_t i = 0; i < std::int64_t(data.block) * data.block * data.block; ++i)
            if (!query.known || query.known[i]) largest = std::max(largest, std::abs(query.samples[i]));
        mMargin = 6e-7f * largest;  // roundings to float, of a mean here and in the pyramid
    }

    // Coarse to fine: positions that a level leaves are bounded by the next one, cube by cube, those
    // with the least bound first. The node with the least bound so far is compared immediately, so
    // that the limit falls early.
    PartialSearch run() {
        if (mCandidates.empty()) return {};
        if (mKnown == 0) return {firstPositions(), true};
        // A hint does not win a tie against a smaller position: bounds equal to the limit are still opened.
        for (const Index3& hint : mQuery.hints)
            if (mCandidates.contains(hint) && mData.eligible(hint)) mBest.add({hint, cost(hint)});
        std::vector<SurvivingCube> cubes = openGroups();
        for (std::size_t l = 1; l < mData.cells.size() && worthIt(); ++l)
            cubes = refine(cubes, mData.means[l], mData.cells[l], l < 2 ? kFewNodes : kFewBlocks);
        const auto crowded = [](const SurvivingCube& g) { return g.end - g.begin > kFewBlocks; };
        if (worthIt() && std::any_of(cubes.begin(), cubes.end(), crowded))
            refine(cubes, mData.means.back(), 1, kFewBlocks);
        if (worthIt()) compareSurvivors();
        return {mBest.matches(), worthIt()};
    }

private:
    // Exact: a bound equal to the limit is still followed, the tie goes by position.
    double pruneAbove() const { return mBest.limit() * mPruneShare; }

    bool worthIt() const { return mWork <= mMostWork; }

    double cost(const Index3& position) {
        ++mCounts.exact;
        mWork += double(mKnown);  // most are abandoned early
        return mData.cost(position, mQuery, mKnown, mBest.limit());
    }

    // Every block costs 0: the first eligible positions, by order.
    std::vector<BlockMatch> firstPositions() {
        for (std::uint32_t node = 0; node < mData.nodeCount(); ++node) addMembers(node, 0.0);
        return mBest.matches();
    }

    std::vector<SurvivingCube> openGroups() {
        const QueryLevel level = queryLevel(mQuery, mData.block, mData.cells.front(), mKnown);
        const LevelBound bounds(level, mMargin);
        std::vector<SurvivingCube> all = boundGroups(level, bounds), opened;
        probe(all, bounds);
        // Every sixteenth first, to estimate the work of all.
        const double before = mWork;
        for (std::size_t offset = 0; offset < kSample; ++offset) {
            for (std::size_t i = offset; i < all.size(); i += kSample) {
                if (double(all[i].least) > pruneAbove() || !worthIt()) break;
                openCube(all[i], bounds);
                if (all[i].begin != all[i].end) opened.push_back(all[i]);
            }
            if (offset > 0 || all.size() < 4 * kSample) continue;
            const double next = workOfLevel(opened, kFewNodes, 8 * level.mean.size(), false);
            if (before + double(kSample) * (mWork - before + next) > mMostWork) giveUp();
        }
        return opened;
    }

    // Cubes with the groups that may contain the answer, those with the least bound first.
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

    // Follows the cubes with the least bounds to the end, for a limit that leaves little work.
    void probe(const std::vector<SurvivingCube>& cubes, const LevelBound& coarsest) {
        std::vector<SurvivingCube> few;
        for (std::size_t i = 0; i < std::min(cubes.size(), kProbedCubes); ++i) {
            few.push_back(cubes[i]);
            openCube(few.back(), coarsest);
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

    // Bounds the nodes of a cube's groups; if there are many, without listing them first.
    void openCube(SurvivingCube& cube, const LevelBound& level) {
        const LevelField& field = mData.means.front();
        const double prune = pruneAbove();
        std::size_t count = 0;
        std::uint64_t rows = 0;
        for (std::size_t i = cube.begin; i < cube.end; ++i) {
            if (double(mGroups[i].first) > prune) continue;
            const BlockGroup& group = mData.groups[mGroups[i].second];
            count += group.last - group.first;
            rows |= rowsOf(group.box);
        }
        if (mRestricted || count <= kFewNodes) {
            gather(cube);
            boundNodes(level, field, kFewNodes, cube);
            return;
        }
        const float limit = level.squaresFor(prune);
        const Index3 corner = cubeCorner(mData.groups[mGroups[cube.begin].second].box.min);
        const float* const sums = mCube.bound(level, field, corner, limit, rows).data();
        countWork(count, rows, level.meanCount());
        Keeping keeping = beginKeeping(level, limit);
        const std::size_t begin = cube.begin, end = cube.end;
        for (std::size_t i = begin; i < end; ++i) {
            const auto [bound, number] = mGroups[i];
            if (double(bound) > prune) continue;
            ++mCounts.groups;
            const BlockGroup& group = mData.groups[number];
            for (std::uint32_t node = group.first; node < group.last; ++node)
                keep(keeping, bound, node, sums[mData.places[node]]);
        }
        finishKeeping(keeping, cube);
    }

    // The rows of a cube that a box within it touches, as CubeBounds takes them.
    static std::uint64_t rowsOf(const IndexBox& box) {
        const int y = box.min.y % kNodeCube, count = box.max.y - box.min.y + 1;
        std::uint64_t rows = 0;
        for (int x = box.min.x; x <= box.max.x; ++x)
            rows |= ((std::uint64_t(1) << count) - 1) << (x % kNodeCube * kNodeCube + y);
        return rows;
    }

    // The nodes of a cube's groups that may be the answer.
    void gather(const SurvivingCube& cube) {
        mNodes.clear();
        const double prune = pruneAbove();
        for (std::size_t i = cube.begin; i < cube.end; ++i) {
            const auto& [bound, group] = mGroups[i];
            if (double(bound) > prune) continue;
            ++mCounts.groups;
            const BlockGroup& of = mData.groups[group];
            for (std::uint32_t node = of.first; node < of.last; ++node)
                if (!mRestricted || mData.isShared(node) || mCandidates.contains(mData.position(node)))
                    mNodes.emplace_back(bound, node);
        }
    }

    // Distance of the query's eight means from the group's ranges; unknown means contribute nothing.
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

    // Bounds the nodes in mNodes that are still candidates, and keeps those that remain as survivors.
    void boundNodes(const LevelBound& level, const LevelField& field, std::size_t few, SurvivingCube& cube) {
        const float limit = level.squaresFor(pruneAbove());
        Keeping keeping = beginKeeping(level, limit);
        if (mNodes.size() > few) {
            const Index3 corner = cubeCorner(mData.position(mNodes.front().node));
            std::uint64_t rows = 0;
            for (const SurvivingNode& node : mNodes)
                rows |= std::uint64_t(1) << (mData.places[node.node] / kNodeCube);
            countWork(mNodes.size(), rows, level.meanCount());
            const float* const sums = mCube.bound(level, field, corner, limit, rows).data();
            for (const SurvivingNode& node : mNodes)
                keep(keeping, node.bound, node.node, sums[mData.places[node.node]]);
        } else {
            mCounts.nodes += mNodes.size();
            mWork += workOneByOne(mNodes.size(), level.meanCount());
            for (const SurvivingNode& node : mNodes)
                keep(keeping, node.bound, node.node, level.ofNode(field, mData.position(node.node), limit));
        }
        finishKeeping(keeping, cube);
    }

    // Survivors of one cube during selection.
    struct Keeping {
        const LevelBound& level;
        float limit;
        std::size_t begin;
        SurvivingNode best{std::numeric_limits<float>::infinity(), 0};
    };
    Keeping beginKeeping(const LevelBound& level, float limit) { return {level, limit, mSurvivors.size()}; }
    void keep(Keeping& keeping, float before, std::uint32_t node, float squares) {
        if (squares > keeping.limit) return;
        const float bound = std::max(before, keeping.level.from(squares));
        mSurvivors.emplace_back(bound, node);
        if (bound < keeping.best.bound) keeping.best = mSurvivors.back();
    }
    void finishKeeping(const Keeping& keeping, SurvivingCube& cube) {
        cube = {keeping.best.bound, keeping.begin, mSurvivors.size()};
        if (cube.least >= mLeast) return;
        mLeast = cube.least;
        evaluate(keeping.best.node);
    }

    // Sums over the samples themselves bound nothing that a comparison would not find: few are left for that.
    std::vector<SurvivingCube> refine(std::vector<SurvivingCube> cubes, const LevelField& field, int cell,
                                      std::size_t few) {
        const QueryLevel level = queryLevel(mQuery, mData.block, cell, mKnown);
        const LevelBound bounds(level, mMargin);
        std::swap(mBefore, mSurvivors);
        mSurvivors.clear();
        mLeast = std::numeric_limits<float>::infinity();
        sortCubes(cubes);
        std::vector<SurvivingCube> left;
        const bool onlyCrowded = cell < mData.block / 4;
        if (mWork + workOfLevel(cubes, few, level.mean.size(), onlyCrowded) > mMostWork) giveUp();
        for (SurvivingCube& cube : cubes) {
            if (double(cube.least) > pruneAbove() || !worthIt()) break;
            mNodes.clear();
            const double prune = pruneAbove();
            for (std::size_t i = cube.begin; i < cube.end; ++i)
                if (double(mBefore[i].bound) <= prune) mNodes.push_back(mBefore[i]);
            if (onlyCrowded && mNodes.size() <= few) {
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

    static double workOneByOne(std::size_t nodes, std::size_t means) {
        return (kSingleWork * double(means) + kNodeWork) * double(nodes);
    }
    static double workTogether(std::size_t nodes, double rows, std::size_t means) {
        return kNodeCube * rows * double(means) + kNodeWork * double(nodes);
    }
    void countWork(std::size_t nodes, std::uint64_t rows, std::size_t means) {
        mCounts.nodes += nodes;
        mWork += workTogether(nodes, double(__builtin_popcountll(rows)), means);
    }

    // Estimated cost of bounding these cubes by that many means.
    double workOfLevel(const std::vector<SurvivingCube>& cubes, std::size_t few, std::size_t means,
                       bool onlyCrowded) const {
        const double prune = pruneAbove();
        double work = 0;
        for (const SurvivingCube& cube : cubes) {
            if (double(cube.least) > prune) continue;
            const std::size_t nodes = cube.end - cube.begin;
            if (nodes > few)
                work += workTogether(nodes, std::min(64.0, double(nodes) / 2), means);
            else if (!onlyCrowded)
                work += workOneByOne(nodes, means);
        }
        return work;
    }
    void giveUp() { mWork = std::numeric_limits<double>::infinity(); }

    void compareSurvivors() {
        std::sort(mSurvivors.begin(), mSurvivors.end(), lessBound);
        for (const SurvivingNode& survivor : mSurvivors) {
            if (double(survivor.bound) > pruneAbove() || !worthIt()) break;
            evaluate(survivor.node);
        }
    }

    static bool lessBound(const SurvivingNode& a, const SurvivingNode& b) {
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

    static constexpr std::size_t kProbedCubes = 8, kProbedNodes = 8, kSample = 16;
    // Work of comparing a mean of a single position, and of the bookkeeping for a node.
    static constexpr double kSingleWork = 10, kNodeWork = 8;
    // Up to this many nodes of a cube are bounded one by one.
    static constexpr std::size_t kFewNodes = 48, kFewBlocks = 64;

    const BlockIndexData& mData;
    const BlockQuery& mQuery;
    BlockSearchCounts& mCounts;
    CubeBounds& mCube;
    std::vector<std::pair<float, std::uint32_t>>& mGroups;
    std::vector<SurvivingNode>&mNodes, &mSurvivors, &mBefore;
    BestBlocks mBest;
    double mWork = 0, mMostWork;
    double mPruneShare;  // a bound is worth following up to this share of the limit
    std::int64_t mKnown;
    IndexBox mCandidates;
    bool mRestricted = false;
    float mMargin = 0;
    float mLeast = std::numeric_limits<float>::infinity();
};

}  // namespace

bool BestBlocks::add(const BlockMatch& match) {
    const auto better = [](const BlockMatch& a, const BlockMatch& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.position < b.position;
    };
    if (mMatches.size() == mCount && better(mMatches.back(), match)) return false;
    const auto place = std::lower_bound(mMatches.begin(), mMatches.end(), match, better);
    if (place != mMatches.end() && place->position == match.position && place->cost == match.cost)
        return true;
    mMatches.insert(place, match);
    if (mMatches.size() > mCount) mMatches.pop_back();
    return true;
}

PartialSearch searchByBounds(const BlockIndexData& data, const BlockQuery& query,
                             const BlockSearchOptions& options, double mostWork, BlockSearchCounts& counts,
                             BlockSearchScratch& scratch) {
    return BoundedSearch(data, query, options, mostWork, counts, scratch).run();
}

}  // namespace vdbsynth
