#include "libvdbsynth/synth/long_runs.h"

#include "libvdbsynth/math/lattice.h"

#include <algorithm>

namespace vdbsynth {
namespace {

// Finds the patches of one run after another, by flooding the lattice.
class Runs {
public:
    Runs(const PatchMap& map, const std::vector<std::uint8_t>& counted)
        : mMap(map), mLattice(map.lattice()), mOpen(counted) {}

    // The run that patch i belongs to; empty if it was returned before.
    const std::vector<std::size_t>& take(std::size_t i) {
        mRun.clear();
        join(i);
        for (std::size_t next = 0; next < mRun.size(); ++next) flood(mRun[next]);
        return mRun;
    }

private:
    void join(std::size_t i) {
        if (!mOpen[i]) return;
        mOpen[i] = 0;
        mRun.push_back(i);
    }

    void flood(std::size_t i) {
        const Index3 place = mMap.place(i), shift = shiftOf(i);
        for (const Index3& step : kFaceNeighbours) {
            const Index3 to = place + step;
            if (!IndexBox::fromSize(mLattice).contains(to)) continue;
            const std::size_t k = latticeIndex(to, mLattice);
            if (mMap.exemplar[k] == mMap.exemplar[i] && shiftOf(k) == shift) join(k);
        }
    }

    Index3 shiftOf(std::size_t i) const { return mMap.source[i] - mMap.originOf(mMap.place(i)); }

    const PatchMap& mMap;
    Index3 mLattice;
    std::vector<std::uint8_t> mOpen;
    std::vector<std::size_t> mRun;
};

// Marks all except the `most` patches of a run that are nearest to its middle.
void markOuter(const PatchMap& map, const std::vector<std::size_t>& run, std::size_t most,
               std::vector<std::uint8_t>& marks) {
    std::int64_t sum[3] = {};
    for (std::size_t i : run)
        for (int axis = 0; axis < 3; ++axis) sum[axis] += map.place(i)[axis];
    const std::int64_t count = std::int64_t(run.size());
    std::vector<std::pair<std::int64_t, std::size_t>> byDistance;
    for (std::size_t i : run) {
        const Index3 place = map.place(i);
        std::int64_t squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t apart = place[axis] - sum[axis] / count;
            squared += apart * apart;
        }
        byDistance.emplace_back(squared, i);
    }
    std::sort(byDistance.begin(), byDistance.end());
    for (std::size_t k = most; k < byDistance.size(); ++k) marks[byDistance[k].second] = 1;
}

}  // namespace

std::vector<std::uint8_t> patchesTooMany(const PatchLevel& level, const PatchMap& map,
                                         const std::vector<std::uint8_t>& counted, double share) {
    std::vector<std::uint8_t> marks(map.source.size(), 0);
    Runs runs(map, counted);
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const std::vector<std::size_t>& run = runs.take(i);
        const double most = share * level.surfacePlaces[std::size_t(map.exemplar[i])];
        if (double(run.size()) > std::max(1.0, most))
            markOuter(map, run, std::size_t(std::max(1.0, most)), marks);
    }
    return marks;
}

}  // namespace vdbsynth
