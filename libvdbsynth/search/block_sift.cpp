#include "libvdbsynth/search/block_sift.h"

#include "libvdbsynth/search/block_cost.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace vdbsynth {
namespace {

// Positions that may be among the best of one query, by costs with an error bound.
class Sieve {
public:
    Sieve(const BlockIndexData& data, const SiftedQuery& sifted, int count)
        : mData(data),
          mSifted(sifted),
          mCount(std::size_t(count)),
          mMost(std::max<std::size_t>(8192, 8 * mCount)) {
        if (!sifted.query) return;
        mBox = sifted.query->candidates.empty() ? data.positions
                                                : sifted.query->candidates.intersection(data.positions);
        if (sifted.before.size() >= mCount) mKnownLimit = sifted.before[mCount - 1].cost;
    }

    void row(int x, int y, const float* costs, float off) {
        if (mCrowded || x < mBox.min.x || x > mBox.max.x || y < mBox.min.y || y > mBox.max.y) return;
        if (mOff != double(off)) {
            mOff = double(off);
            setHighest();
        }
        for (int z = mBox.min.z; z <= mBox.max.z; ++z)
            if (double(costs[z]) <= mHighest && mData.eligible({x, y, z})) add({x, y, z}, costs[z]);
    }

    PartialSearch decide(int block, BlockSearchCounts& counts) {
        BestBlocks best{int(mCount)};
        for (const BlockMatch& match : mSifted.before) best.add(match);
        if (mCrowded) return {best.matches(), false};
        const BlockQuery& query = *mSifted.query;
        const std::int64_t known = countKnown(query.known, block);
        std::sort(mFound.begin(), mFound.end());
        for (const auto& [cost, number] : mFound) {
            if (double(cost) - mOff > best.limit()) break;
            const Index3 position = mData.positionOf(number);
            ++counts.exact;
            best.add({position, mData.cost(position, query, known, best.limit())});
        }
        return {best.matches(), true};
    }

private:
    void add(const Index3& position, float cost) {
        mFound.emplace_back(cost, mData.numberOf(position));
        mLeast.push_back(cost);
        std::push_heap(mLeast.begin(), mLeast.end());
        if (mLeast.size() > mCount) {
            std::pop_heap(mLeast.begin(), mLeast.end());
            mLeast.pop_back();
        }
        setHighest();
        if (mFound.size() <= mMost) return;
        mFound.erase(std::remove_if(mFound.begin(), mFound.end(),
                                    [&](const auto& found) { return double(found.first) > mHighest; }),
                     mFound.end());
        mCrowded = mFound.size() > mMost / 2;
    }

    // A cost with an error of at most mOff is certainly too high above this.
    void setHighest() {
        const double least =
            mLeast.size() == mCount ? double(mLeast.front()) + mOff : std::numeric_limits<double>::infinity();
        mHighest = std::min(least, mKnownLimit) + mOff;
    }

    const BlockIndexData& mData;
    const SiftedQuery& mSifted;
    std::size_t mCount, mMost;
    IndexBox mBox;
    double mOff = 0, mHighest = std::numeric_limits<double>::infinity(),
           mKnownLimit = std::numeric_limits<double>::infinity();
    std::vector<float> mLeast;  // heap of the least costs
    std::vector<std::pair<float, std::uint64_t>> mFound;
    bool mCrowded = false;
};

}  // namespace

std::array<PartialSearch, 2> searchByCorrelation(const BlockIndexData& data,
                                                 const BlockCorrelation& correlation,
                                                 const std::array<SiftedQuery, 2>& queries, int count,
                                                 BlockSearchCounts& counts,
                                                 BlockCorrelation::Workspace& workspace) {
    std::array<Sieve, 2> sieves{Sieve(data, queries[0], count), Sieve(data, queries[1], count)};
    correlation.costs(*queries[0].query, queries[1].query, workspace,
                      [&](int slot, int x, int y, const float* costs, int, float off) {
                          sieves[std::size_t(slot)].row(x, y, costs, off);
                      });
    std::array<PartialSearch, 2> found;
    for (std::size_t i = 0; i < 2; ++i)
        if (queries[i].query) {
            found[i] = sieves[i].decide(data.block, counts);
            counts.transforms += found[i].finished;
        }
    return found;
}

}  // namespace vdbsynth
