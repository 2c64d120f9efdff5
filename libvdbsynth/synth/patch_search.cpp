#include "libvdbsynth/synth/patch_search.h"

#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/synth/long_runs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kDrawPurpose = 0x70730000;
constexpr float kCostFloor = 0.02f;  // [voxels^2] added to costs before they are compared
// Share added for every use above the expected number. Of 0 and 2, by distances to the exemplar's statistics
// (docs/decisions/010): without it thick places are matched too often and the volume fraction rises.
constexpr float kOverusePenalty = 2;
constexpr float kCompanionDiscount = 0.1f;  // share subtracted for each neighbour that the source continues
constexpr float kTooMany = 8;        // factor on the cost of a source that extends a piece beyond its limit
constexpr float kAgreement = 0.01f;  // [voxels^2] cost of patches that agree
constexpr std::size_t kPatchesAChunk = 64;
constexpr std::int64_t kMostDense = 1 << 24;  // [voxels] of a field that are dense at once

// Number of uses of each part of each exemplar as a source, in cells of a stride.
class Uses {
public:
    Uses(const PatchLevel& level, const PatchMap& map, const std::vector<std::uint8_t>& varied)
        : mHalf(map.block / 2), mSide(map.stride) {
        for (const DenseField& exemplar : level.exemplars) {
            Cells cells;
            for (int axis = 0; axis < 3; ++axis) cells.size[axis] = exemplar.size[axis] / mSide + 1;
            cells.count.assign(latticeCount(cells.size), 0);
            mCells.push_back(std::move(cells));
        }
        std::vector<double> uses(mCells.size(), 0);
        for (std::size_t i = 0; i < map.source.size(); ++i)
            if (varied[i]) {
                Cells& cells = mCells[std::size_t(map.exemplar[i])];
                cells.count[cellOf(cells, map.source[i])] += 1;
                uses[std::size_t(map.exemplar[i])] += 1;
            }
        // Exemplars with assigned regions are not expected to be used equally.
        double all = 0, places = 0;
        for (std::size_t e = 0; e < uses.size(); ++e) {
            all += uses[e];
            places += level.surfacePlaces[e];
        }
        for (std::size_t e = 0; e < uses.size(); ++e)
            mCells[e].expected =
                float(std::max(0.5, level.only.empty() ? all / places : uses[e] / level.surfacePlaces[e]));
    }

    // Factor on a source's cost.
    float penalty(std::size_t exemplar, const Index3& source) const {
        const Cells& cells = mCells[exemplar];
        return 1 + kOverusePenalty * std::max(0.f, cells.count[cellOf(cells, source)] / cells.expected - 1);
    }

private:
    struct Cells {
        Index3 size;
        std::vector<float> count;
        float expected = 1;
    };
    std::size_t cellOf(const Cells& cells, const Index3& source) const {
        return latticeIndex(
            {(source.x + mHalf) / mSide, (source.y + mHalf) / mSide, (source.z + mHalf) / mSide}, cells.size);
    }

    int mHalf, mSide;
    std::vector<Cells> mCells;
};

struct Source {
    Index3 place;
    std::int32_t exemplar = 0;
    float cost = 0;                                                // mean squared difference plus guidance
    float penalizedCost = std::numeric_limits<float>::infinity();  // what is compared
};

// Searches the best source of one patch after another.
class PatchSearch {
public:
    /// @param slab  planes of the field that patches are read from, and the first one's number
    /// @param tooMany  patchesTooMany
    PatchSearch(const PatchLevel& level, const PatchMap& map, const Uses& uses,
                const std::vector<std::uint8_t>& tooMany, const DenseField& slab, int firstPlane)
        : mLevel(level),
          mMap(map),
          mUses(uses),
          mTooMany(tooMany),
          mSlab(slab),
          mFirst(firstPlane),
          mLattice(map.lattice()) {}

    std::uint64_t compared() const { return mCompared; }

    Source search(std::size_t i, int round, std::uint64_t seed) {
        mNumber = i;
        mPlace = mMap.place(i);
        mOrigin = mMap.originOf(mPlace);
        const std::ptrdiff_t row = mSlab.size.z;
        mPatch = {mSlab.row(mOrigin.x - mFirst, mOrigin.y, mOrigin.z), row * mSlab.size.y, row};
        mBest = {};
        look(mMap.exemplar[i], mMap.source[i]);
        lookAtNeighbours(round % 3 == 2 ? 2 : 1);
        lookAround(i, round, seed);
        // No eligible position was tried: a mask with little left. Take the first eligible one.
        if (!std::isfinite(mBest.penalizedCost)) lookEverywhere();
        return mBest;
    }

private:
    void look(std::int32_t exemplar, const Index3& place) {
        const std::size_t e = std::size_t(exemplar);
        // Neighbours that continue a copy propose the same position again.
        if (exemplar == mBest.exemplar && place == mBest.place && std::isfinite(mBest.penalizedCost)) return;
        if (!mLevel.allows(mNumber, exemplar) || !sourcesFor(mLevel, mMap, e, mOrigin).contains(place) ||
            !mLevel.eligible(e, place))
            return;
        const bool tooMany =
            mTooMany[mNumber] && exemplar == mMap.exemplar[mNumber] && place == mMap.source[mNumber];
        const float factor =
            mUses.penalty(e, place) *
            (tooMany ? kTooMany : 1 - kCompanionDiscount * float(companions(exemplar, place)));
        const float guided = mLevel.guidance.empty() ? 0.f : mLevel.guidance.cost(mOrigin, e, place);
        const float giveUp = mBest.penalizedCost / factor - kCostFloor - guided;
        if (giveUp < 0) return;
        const float cost = patchDifference(mPatch, mLevel.exemplars[e], place, mMap.block, giveUp);
        ++mCompared;
        const float penalizedCost = (cost + guided + kCostFloor) * factor;
        if (penalizedCost < mBest.penalizedCost) mBest = {place, exemplar, cost + guided, penalizedCost};
    }

    // Number of neighbours whose sources have the same offsets as the patches: 0 to 6.
    int companions(std::int32_t exemplar, const Index3& place) const {
        int count = 0;
        for (const Index3& step : kFaceNeighbours) {
            const Index3 other = mPlace + step;
            if (!IndexBox::fromSize(mLattice).contains(other)) continue;
            const std::size_t k = latticeIndex(other, mLattice);
            count += mMap.exemplar[k] == exemplar && mMap.source[k] - mMap.originOf(other) == place - mOrigin;
        }
        return count;
    }

    void lookAtNeighbours(int step) {
        for (const Index3& side : kFaceNeighbours) {
            const Index3 other = mPlace + side * step;
            if (!IndexBox::fromSize(mLattice).contains(other)) continue;
            const std::size_t k = latticeIndex(other, mLattice);
            look(mMap.exemplar[k], mMap.source[k] + mOrigin - mMap.originOf(other));
        }
    }

    // Positions drawn from boxes around the best, each half as wide as the one before.
    void lookAround(std::size_t i, int round, std::uint64_t seed) {
        Random random(seed, i, kDrawPurpose + std::uint32_t(round));
        const std::uint32_t count = std::uint32_t(mLevel.exemplars.size());
        std::int32_t exemplar = count > 1 ? std::int32_t(random.below(count)) : 0;
        if (!mLevel.only.empty() && mLevel.only[i] >= 0) exemplar = mLevel.only[i];
        const Index3 size = sourcesFor(mLevel, mMap, std::size_t(exemplar), mOrigin).size();
        for (int radius = std::max({size.x, size.y, size.z}); radius >= 1; radius /= 2) {
            const IndexBox box = sourcesFor(mLevel, mMap, std::size_t(exemplar), mOrigin);
            if (box.empty()) return;
            const Index3 centre = mBest.exemplar == exemplar ? mBest.place : box.min;
            Index3 place;
            for (int axis = 0; axis < 3; ++axis) {
                const int low = std::max(box.min[axis], centre[axis] - radius),
                          high = std::max(low, std::min(box.max[axis], centre[axis] + radius));
                place[axis] = low + int(random.below(std::uint32_t(high - low + 1)));
            }
            look(exemplar, place);
            exemplar = mBest.exemplar;
        }
    }

    void lookEverywhere() {
        for (std::size_t e = 0; e < mLevel.exemplars.size(); ++e)
            for (const Index3& place : mLevel.fallbacks[e]) look(std::int32_t(e), place);
        if (std::isfinite(mBest.penalizedCost)) return;
        for (std::size_t e = 0; e < mLevel.exemplars.size(); ++e) {
            if (!mLevel.allows(mNumber, std::int32_t(e))) continue;
            const IndexBox box = sourcesFor(mLevel, mMap, e, mOrigin);
            forEachVoxel(box, [&](const Index3& place) { look(std::int32_t(e), place); });
        }
    }

    const PatchLevel& mLevel;
    const PatchMap& mMap;
    const Uses& mUses;
    const std::vector<std::uint8_t>& mTooMany;
    const DenseField& mSlab;
    int mFirst;
    Index3 mLattice;
    PatchView mPatch{};
    std::size_t mNumber = 0;
    Index3 mPlace, mOrigin;
    Source mBest;
    std::uint64_t mCompared = 0;
};

// 1 where a patch's samples in the field have more than one value.
std::vector<std::uint8_t> variedPatches(const PatchMap& map, const BrickField& field, const RunContext& ctx) {
    std::vector<std::uint8_t> varied(map.source.size());
    parallelFor(ctx, varied.size(), 1024, [&](std::size_t begin, std::size_t end) {
        float value;
        for (std::size_t i = begin; i < end; ++i)
            varied[i] = !field.constantIn(IndexBox::cube(map.originOf(map.place(i)), map.block), value);
    });
    return varied;
}

// True if a patch and its source are constant and equal: nothing is nearer.
bool settled(const PatchLevel& level, const PatchMap& map, const BrickField& field, std::size_t i) {
    float own, source;
    return level.allows(i, map.exemplar[i]) && level.guidance.empty() &&
           field.constantIn(IndexBox::cube(map.originOf(map.place(i)), map.block), own) &&
           level.pass->exemplars[std::size_t(map.exemplar[i])]->constantIn(
               IndexBox::cube(map.source[i], map.block), source) &&
           own == source;
}

// (agreement / (cost + agreement))^2.5, by a square root, which is the same on every processor.
float weightFor(float cost) {
    const float ratio = kAgreement / (cost + kAgreement);
    return ratio * ratio * std::sqrt(ratio);
}

}  // namespace

__attribute__((target_clones("avx2", "default"))) float patchDifference(const PatchView& patch,
                                                                        const DenseField& in,
                                                                        const Index3& corner, int n,
                                                                        float giveUp) {
    const float samples = float(n) * float(n) * float(n), limit = giveUp * samples;
    const float* const source = in.row(corner.x, corner.y, corner.z);
    const std::ptrdiff_t row = in.size.z, plane = row * in.size.y;
    float total = 0;
    for (const int first : {0, 2, 1, 3})
        for (int x = first; x < n; x += 4) {
            float lanes[8] = {};
            for (int y = 0; y < n; ++y) {
                const float* a = patch.first + x * patch.plane + y * patch.row;
                const float* b = source + x * plane + y * row;
                int z = 0;
                for (; z + 8 <= n; z += 8)
                    for (int k = 0; k < 8; ++k) lanes[k] += (a[z + k] - b[z + k]) * (a[z + k] - b[z + k]);
                for (; z + 4 <= n; z += 4)
                    for (int k = 0; k < 4; ++k) lanes[k] += (a[z + k] - b[z + k]) * (a[z + k] - b[z + k]);
                for (; z < n; ++z) lanes[z & 7] += (a[z] - b[z]) * (a[z] - b[z]);
            }
            total += ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
                     ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
            if (total > limit) return total / samples;
        }
    return total / samples;
}

namespace {

// Planes of a field from `first` on as one array.
DenseField densePlanes(const BrickField& field, int first, int count, const RunContext& ctx) {
    const Index3 size = field.box().size();
    DenseField slab;
    slab.size = {count, size.y, size.z};
    const std::size_t planeSamples = std::size_t(size.y) * std::size_t(size.z);
    slab.samples.resize(std::size_t(count) * planeSamples);
    parallelFor(ctx, std::size_t(count), 4, [&](std::size_t begin, std::size_t end) {
        field.readBox({first + int(begin), 0, 0}, {int(end - begin), size.y, size.z},
                      slab.samples.data() + begin * planeSamples);
    });
    return slab;
}

// The sources of the patches that search, each based on the state before the round.
std::vector<Source> foundSources(const PatchLevel& level, const BrickField& field, int round,
                                 const std::vector<std::uint8_t>& searches,
                                 const std::vector<std::uint8_t>& tooMany, const Uses& uses,
                                 const PatchMap& map, RoundCounts& counts, const RunContext& ctx) {
    std::vector<Source> found(map.source.size());
    const Index3 lattice = map.lattice(), size = field.box().size();
    const std::size_t layer = std::size_t(lattice.y) * std::size_t(lattice.z);
    const std::int64_t planes = kMostDense / (std::int64_t(size.y) * size.z);
    const int layers = int(std::max<std::int64_t>(1, (planes - map.block) / map.stride));
    for (int first = 0; first < lattice.x; first += layers) {
        const int last = std::min(first + layers, lattice.x) - 1, plane = map.origin(0, first);
        const DenseField slab = densePlanes(field, plane, map.origin(0, last) + map.block - plane, ctx);
        const std::size_t begun = std::size_t(first) * layer, all = std::size_t(last - first + 1) * layer;
        std::vector<std::uint64_t> compared((all + kPatchesAChunk - 1) / kPatchesAChunk, 0);
        parallelFor(ctx, all, kPatchesAChunk, [&](std::size_t begin, std::size_t end) {
            PatchSearch search(level, map, uses, tooMany, slab, plane);
            for (std::size_t i = begun + begin; i < begun + end; ++i)
                if (searches[i]) found[i] = search.search(i, round, ctx.seed);
            compared[begin / kPatchesAChunk] = search.compared();
        });
        for (std::uint64_t n : compared) counts.compared += n;
    }
    return found;
}

void takeFound(const std::vector<std::uint8_t>& searches, const std::vector<Source>& found, PatchMap& map) {
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (!searches[i]) continue;
        map.source[i] = found[i].place;
        map.exemplar[i] = found[i].exemplar;
        map.weight[i] = weightFor(found[i].cost);
    }
}

// 1 for patches with a surface that search for their own source.
std::vector<std::uint8_t> patchesThatCount(const PatchLevel& level, const PatchMap& map,
                                           const BrickField& field, const RunContext& ctx) {
    std::vector<std::uint8_t> counted = variedPatches(map, field, ctx);
    for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = counted[i] && !level.keeps(i);
    return counted;
}

}  // namespace

RoundCounts improveSources(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                           const RunContext& ctx) {
    const std::vector<std::uint8_t> counted = patchesThatCount(level, map, field, ctx);
    const std::vector<std::uint8_t> tooMany = patchesTooMany(level, map, counted, level.options->longestRun);
    const Uses uses(level, map, counted);
    std::vector<std::uint8_t> searches(counted.size());
    parallelFor(ctx, searches.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            searches[i] = !level.keeps(i) && !settled(level, map, field, i);
    });
    RoundCounts counts;
    const std::vector<Source> found =
        foundSources(level, field, round, searches, tooMany, uses, map, counts, ctx);
    map.weight.assign(searches.size(), weightFor(0));
    takeFound(searches, found, map);
    copyRepeats(level, map);
    for (const Source& source : found) counts.cost += double(source.cost) / double(found.size());
    counts.patches = found.size();
    return counts;
}

std::size_t shortenRuns(const PatchLevel& level, const BrickField& field, int round, PatchMap& map,
                        const RunContext& ctx) {
    const std::vector<std::uint8_t> counted = patchesThatCount(level, map, field, ctx);
    const std::vector<std::uint8_t> tooMany = patchesTooMany(level, map, counted, level.options->longestRun);
    const auto many = std::size_t(std::count(tooMany.begin(), tooMany.end(), 1));
    if (many == 0) return 0;
    RoundCounts counts;
    const Uses uses(level, map, counted);
    takeFound(tooMany, foundSources(level, field, round, tooMany, tooMany, uses, map, counts, ctx), map);
    copyRepeats(level, map);
    return many;
}

}  // namespace vdbsynth
