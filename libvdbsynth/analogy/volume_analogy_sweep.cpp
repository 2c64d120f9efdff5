// The sweeps over a level.
#include "libvdbsynth/analogy/volume_analogy_level_steps.h"

#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr float kWave = 0.5f;  // [voxels of the level] of sweep distance
// Squared distance of features, of densities from 0 to 1, below which no nearer one looks better. Smooth
// parts of a pair have thousands of those, and a search among them is long: half the time of thorns.
constexpr float kSame = 1e-3f;

}  // namespace

AnalogyLevelStats AnalogyLevel::run() {
    AnalogyLevelStats stats;
    const std::vector<std::size_t> waves = orderWaves();
    stats.voxels = mVoxels.table.size();
    stats.waves = waves.size() - 1;
    stats.features = mTraining.index().size();
    stats.components = mTraining.reduced().count();
    stats.explained = mTraining.axes().explained;
    projectRests();
    Stage stage(mContext, "analogy, level " + std::to_string(mLevel + 1),
                std::size_t(mOptions.sweeps) * waves.size());
    for (int sweep = 0; sweep < mOptions.sweeps; ++sweep)
        for (std::size_t w = 0; w + 1 < waves.size(); ++w) {
            ++mNow;
            runWave(waves[w], waves[w + 1], sweep == 0);
            stage.advance();
        }
    const std::ptrdiff_t coherent = std::count(mCoherent.begin(), mCoherent.end(), 1);
    stats.coherent = double(coherent) / double(std::max<std::size_t>(mSource.size(), 1));
    probe(stats);
    return stats;
}

Vec3f AnalogyLevel::placeOf(std::size_t i) const {
    return featurePlace(middleOf(mVoxels.table[i]), mVoxels.frame[i], mPlain.inside(mVoxels.table[i]),
                        mOptions.aligned);
}

void AnalogyLevel::featureOf(std::size_t i, std::vector<float>& made, std::vector<float>& feature) const {
    sampleMade(mShape, mDensity, placeOf(i), mVoxels.frame[i], mVoxels.curvature[i], made.data());
    mTraining.reduced().addMade(made.data(), mRest.data() + i * feature.size(), feature.data());
}

std::vector<std::size_t> AnalogyLevel::orderWaves() {
    const float thickness = kWave * float(1 << mLevel);
    std::vector<std::pair<int, std::uint32_t>> order(mVoxels.table.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = {int(std::floor(mVoxels.sweep[i] / thickness)), i};
    parallelSort(mContext, order);
    std::vector<std::size_t> waves;
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k == 0 || order[k].first != order[k - 1].first) waves.push_back(k);
        mOrder.push_back(order[k].second);
    }
    waves.push_back(order.size());
    return waves;
}

void AnalogyLevel::projectRests() {
    const std::size_t count = mTraining.reduced().count();
    mRest.resize(mVoxels.table.size() * count);
    FeatureFields fields{&mPlainDensity, mCoarsePlain, mCoarser ? &mCoarser->density : nullptr};
    parallelFor(mContext, mVoxels.table.size(), 256, [&](std::size_t first, std::size_t last) {
        std::vector<float> rest(mShape.rest());
        for (std::size_t i = first; i < last; ++i) {
            sampleRest(mShape, fields, placeOf(i), mVoxels.frame[i], mVoxels.curvature[i], rest.data());
            mTraining.reduced().ofRest(rest.data(),
                                       featureDepth(mPlain.inside(mVoxels.table[i]), mOptions.aligned),
                                       mRest.data() + i * count);
        }
    });
}

void AnalogyLevel::runWave(std::size_t first, std::size_t last, bool searched) {
    mFound.resize(last - first);
    parallelFor(mContext, last - first, 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> made(mShape.made()), feature(mTraining.reduced().count());
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = mOrder[first + k];
            mFound[k] = searched || changedAround(i) ? match(i, searched, made, feature) : Found{};
        }
    });
    for (std::size_t k = 0; k < mFound.size(); ++k) {
        if (mFound[k].source.row < 0) continue;
        const std::uint32_t i = mOrder[first + k];
        mComputed[i] = mNow;
        if (mSource[i].row == mFound[k].source.row && !searched) continue;
        mCoherent[i] = mFound[k].coherent;
        if (mSource[i].row != mFound[k].source.row) {
            mChanged[i] = mNow;
            mUsage.change(mSource[i].row, mFound[k].source.row);
        }
        mSource[i] = mFound[k].source;
        const float distance = std::clamp(mFound[k].distance, -kAnalogyFar, kAnalogyFar),
                    density = densityOf(distance);
        mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &distance);
        mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
    }
}

bool AnalogyLevel::changedAround(std::uint32_t i) const {
    if (mChanged[i] >= mComputed[i]) return true;
    for (const Index3& step : kAllNeighbours) {
        const std::int32_t j = mVoxels.table.find(mVoxels.table[i] + step);
        if (j >= 0 && mChanged[std::size_t(j)] >= mComputed[i]) return true;
    }
    return false;
}

AnalogyLevel::Found AnalogyLevel::match(std::uint32_t i, bool searched, std::vector<float>& made,
                                        std::vector<float>& feature) const {
    const FeatureIndex& index = mTraining.index();
    featureOf(i, made, feature);
    const Candidate best = bestCandidate(i, feature.data());
    Found found;
    found.source = best.source;
    found.coherent = 1;
    // Later sweeps refine the first one's result; only voxels without a candidate search again.
    if (best.source.row < 0 || (searched && best.squared >= kSame)) {
        // The nearest row replaces a candidate that continues a neighbour only if
        // it is nearer by this factor.
        const float more = 1 + float(mOptions.coherence) / float(1 << mLevel);
        const float bound = best.source.row < 0 ? kOutside : best.squared / (more * more);
        const FeatureMatch nearest = index.nearest(feature.data(), bound, float(mOptions.epsilon));
        if (nearest.row >= 0 && nearest.squared * mUsage.cost(nearest.row) < bound) {
            found.source = mTraining.featureSource(nearest.row);
            found.coherent = 0;
        }
    }
    found.distance = readThrough(i, found.source, mVoxels.table[i]);
    return found;
}

AnalogyLevel::Candidate AnalogyLevel::bestCandidate(std::uint32_t i, const float* feature) const {
    std::array<std::int32_t, 28> tried;
    std::size_t count = 0;
    Candidate best;
    const auto consider = [&](const AnalogySource& source) {
        const auto end = tried.begin() + std::ptrdiff_t(count);
        if (source.row < 0 || std::find(tried.begin(), end, source.row) != end) return;
        tried[count++] = source.row;
        const float squared = mTraining.index().squaredTo(feature, source.row) * mUsage.cost(source.row);
        if (squared < best.squared || (squared == best.squared && source.row < best.source.row))
            best = {source, squared};
    };
    consider(mSource[i]);
    const Index3& v = mVoxels.table[i];
    forEachVoxel(IndexBox{v, v}.expanded(1), [&](const Index3& p) {
        const std::int32_t j = p == v ? -1 : mVoxels.table.find(p);
        if (j >= 0 && mSource[std::size_t(j)].row >= 0) consider(continued(i, std::size_t(j), p - v));
    });
    return best;
}

AnalogySource AnalogyLevel::continued(std::size_t i, std::size_t j, const Index3& step) const {
    const AnalogyRow& row = mTraining.row(mSource[j].row);
    const Frame& frame = mTraining.frame(row);
    Vec3f from = mTraining.placeOf(mSource[j]) - rotated(mVoxels.frame[j], frame, middleOf(step));
    from = from + frame.n * (mPlain.inside(mVoxels.table[i]) - mTraining.plainThrough(row, from));
    return mTraining.sourceAt(row.pair, from);
}

}  // namespace vdbsynth
