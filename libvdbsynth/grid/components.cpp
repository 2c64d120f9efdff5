// Connected components by runs along z: each run of a row is joined to the runs it
// touches in the rows before.
#include "libvdbsynth/grid/components.h"

#include "libvdbsynth/grid/occupancy.h"

#include "libvdbsynth/math/disjoint_sets.h"

#include <algorithm>
#include <functional>

namespace vdbsynth {
namespace {

struct Run {
    int begin, end;  // [begin, end) along z
};

// The runs of solid voxels of one row.
void appendRuns(const std::uint64_t* row, std::size_t words, int sizeZ, std::vector<Run>& runs) {
    int z = 0;
    const auto next = [&](int from, bool solid) {
        for (std::size_t word = std::size_t(from) >> 6; word < words; ++word) {
            std::uint64_t bits = solid ? row[word] : ~row[word];
            if (word == std::size_t(from) >> 6) bits &= ~std::uint64_t(0) << (from & 63);
            if (bits != 0) return std::min(sizeZ, int(word) * 64 + __builtin_ctzll(bits));
        }
        return sizeZ;
    };
    while ((z = next(z, true)) < sizeZ) {
        const int end = next(z, false);
        runs.push_back({z, end});
        if (end >= sizeZ) break;
        z = end;
    }
}

// Joins the runs [a, aEnd) with the runs [b, bEnd) of a neighbouring row that they touch.
void joinRows(const std::vector<Run>& runs, std::size_t a, std::size_t aEnd, std::size_t b, std::size_t bEnd,
              int reach, DisjointSets& forest) {
    while (a < aEnd && b < bEnd) {
        if (runs[a].begin < runs[b].end + reach && runs[b].begin < runs[a].end + reach)
            forest.join(std::uint32_t(a), std::uint32_t(b));
        if (runs[a].end < runs[b].end)
            ++a;
        else
            ++b;
    }
}

// All runs of a solid and the components they belong to.
class Parts {
public:
    Parts(const Occupancy& solid, Neighbours neighbours) : mSize(solid.size()) {
        const std::size_t rows = std::size_t(mSize.x) * std::size_t(mSize.y);
        mFirst.assign(rows + 1, 0);
        const bool all = neighbours == Neighbours::All;
        for (int x = 0; x < mSize.x; ++x)
            for (int y = 0; y < mSize.y; ++y) {
                const std::size_t row = std::size_t(x) * std::size_t(mSize.y) + std::size_t(y);
                mFirst[row] = mRuns.size();
                appendRuns(solid.row(x, y), solid.rowWords(), mSize.z, mRuns);
                mFirst[row + 1] = mRuns.size();
                for (std::size_t run = mFirst[row]; run < mRuns.size(); ++run) mForest.add();
                joinWithRowsBefore(x, y, all);
            }
        measure();
    }

    // The sizes of all components and of those that touch no face, unordered.
    Components sizes() const {
        Components result;
        for (std::size_t run = 0; run < mRuns.size(); ++run)
            if (mVoxels[run] > 0) {
                result.sizes.push_back(mVoxels[run]);
                if (!mTouches[run]) result.interior.push_back(mVoxels[run]);
            }
        return result;
    }

    std::vector<Index3> voxelsOfSmall(std::uint64_t interiorLimit, std::uint64_t cutLimit) {
        std::vector<Index3> voxels;
        for (std::size_t row = 0; row + 1 < mFirst.size(); ++row)
            for (std::size_t run = mFirst[row]; run < mFirst[row + 1]; ++run) {
                const std::uint32_t root = mForest.root(std::uint32_t(run));
                if (mVoxels[root] >= (mTouches[root] ? cutLimit : interiorLimit)) continue;
                for (int z = mRuns[run].begin; z < mRuns[run].end; ++z)
                    voxels.push_back({int(row / std::size_t(mSize.y)), int(row % std::size_t(mSize.y)), z});
            }
        return voxels;
    }

private:
    void joinWithRowsBefore(int x, int y, bool all) {
        const std::size_t row = std::size_t(x) * std::size_t(mSize.y) + std::size_t(y);
        for (int dx = -1; dx <= 0; ++dx)
            for (int dy = -1; dy <= (dx == 0 ? -1 : 1); ++dy) {
                if ((!all && dx != 0 && dy != 0) || x + dx < 0 || y + dy < 0 || y + dy >= mSize.y) continue;
                const std::size_t other = std::size_t(x + dx) * std::size_t(mSize.y) + std::size_t(y + dy);
                joinRows(mRuns, mFirst[row], mFirst[row + 1], mFirst[other], mFirst[other + 1], all ? 1 : 0,
                         mForest);
            }
    }

    void measure() {
        mVoxels.assign(mRuns.size(), 0);
        mTouches.assign(mRuns.size(), 0);
        for (std::size_t row = 0; row + 1 < mFirst.size(); ++row) {
            const int x = int(row / std::size_t(mSize.y)), y = int(row % std::size_t(mSize.y));
            const bool side = x == 0 || y == 0 || x == mSize.x - 1 || y == mSize.y - 1;
            for (std::size_t run = mFirst[row]; run < mFirst[row + 1]; ++run) {
                const std::uint32_t root = mForest.root(std::uint32_t(run));
                mVoxels[root] += std::uint64_t(mRuns[run].end - mRuns[run].begin);
                if (side || mRuns[run].begin == 0 || mRuns[run].end == mSize.z) mTouches[root] = 1;
            }
        }
    }

    Index3 mSize;
    std::vector<Run> mRuns;
    std::vector<std::size_t> mFirst;  // [rows + 1] where each row's runs begin
    DisjointSets mForest;
    std::vector<std::uint64_t> mVoxels;  // [runs] of a component, at its root
    std::vector<char> mTouches;          // [runs] 1: the component touches a face, at its root
};

}  // namespace

Components findComponents(const Occupancy& solid, Neighbours neighbours) {
    Components result = Parts(solid, neighbours).sizes();
    std::sort(result.sizes.begin(), result.sizes.end(), std::greater<>());
    std::sort(result.interior.begin(), result.interior.end(), std::greater<>());
    return result;
}

std::vector<Index3> smallParts(const Occupancy& solid, Neighbours neighbours, std::uint64_t interiorLimit,
                               std::uint64_t cutLimit) {
    return Parts(solid, neighbours).voxelsOfSmall(interiorLimit, cutLimit);
}

}  // namespace vdbsynth
