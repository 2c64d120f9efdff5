#include "libvdbsynth/analogy/volume_analogy.h"

#include "libvdbsynth/analogy/volume_analogy_steps.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kFar = kAnalogyFar;
constexpr float kWave = 0.5f;  // [voxels of the level] of sweep distance

// The state that a level passes to the next finer one.
struct Made {
    BrickField distance, density;
    VoxelTable table;
    std::vector<Frame> frame;
    std::vector<AnalogyRow> source;  // pair -1: none
    std::vector<Vec3f> sourcePlace;
    std::vector<Frame> sourceFrame;
};

// The target at one level: an assignment of a source row to every voxel that has to be synthesised.
// Between two waves:
// - mSource[i] is a position of a pair, or none as long as none was found for voxel i of mVoxels;
// - mDistance is the field as synthesised so far, full or empty (-kFar, kFar) where nothing has to be, and
//   mDensity is densityField of it;
// - mChanged[i] and mComputed[i] are the waves (counted by mNow) in which voxel i last got another source and
//   was last searched; a later sweep searches only voxels that changed, or have a neighbour that did, since;
// - a wave reads only the state before it and writes mFound, which is then applied in order, so results do
//   not depend on threads.
class Level {
public:
    Level(const AnalogyTraining& training, const AnalogyPyramid& target, const FrameField& frames, int level,
          const FeatureShape& shape, const Made* coarser, const VolumeAnalogyOptions& options,
          const RunContext& ctx)
        : mTraining(training),
          mPlain(target.distance[std::size_t(level)]),
          mPlainDensity(target.density[std::size_t(level)]),
          mCoarsePlain(shape.coarse ? &target.density[std::size_t(level) + 1] : nullptr),
          mShape(shape),
          mCoarser(coarser),
          mOptions(options),
          mContext(ctx),
          mLevel(level) {
        mVoxels = analogyVoxels(VoxelTable::where(
                                    mPlain, [&](float d) { return training.depths().open(d); }, ctx),
                                frames, level, options.aligned, options.curvatureAdapted, ctx);
        begin();
    }

    AnalogyLevelStats run() {
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

    Made made() {
        Made result;
        result.distance = voted();
        result.density = densityField(result.distance, mContext);
        for (const AnalogySource& source : mSource) {
            const AnalogyRow row = source.row < 0 ? AnalogyRow{} : mTraining.row(source.row);
            result.source.push_back(row);
            result.sourcePlace.push_back(source.row < 0 ? Vec3f{} : mTraining.placeOf(source));
            result.sourceFrame.push_back(source.row < 0 ? Frame{} : mTraining.frame(row));
        }
        result.frame = mVoxels.frame;
        result.table = mVoxels.table;
        return result;
    }

    // Of the finest level, for the map.
    ElementSources sources() const {
        std::vector<Source> all(mSource.size());
        each(1024, [&](std::size_t i) {
            const AnalogyRow& row = mTraining.row(mSource[i].row);
            const Frame& frame = mTraining.frame(row);
            all[i].exemplar = row.pair;
            all[i].position = cast<double>(atDepth(i, mSource[i]));
            all[i].rotation = rotationBetween(frame, mVoxels.frame[i]);
        });
        ElementSources result;
        for (std::size_t i = 0; i < all.size(); ++i) result.add(mVoxels.table[i], all[i]);
        return result;
    }

private:
    template <typename Work>
    void each(std::size_t grain, Work&& work) const {
        parallelFor(mContext, mVoxels.table.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) work(i);
        });
    }

    // Voxels that need no computation are full or empty; the others start from the plain target, or from the
    // coarser level's result.
    void begin() {
        const BrickField start =
            mCoarser ? doubled(mCoarser->distance, mPlain.box().size(), mContext) : mPlain;
        const float scale = mCoarser ? 2.f : 1.f;
        mDistance = BrickField::generate(mPlain.box(), mContext, [&](const IndexBox& brick, float* samples) {
            std::array<float, BrickField::kSamples> made;
            mPlain.readBox(brick.min, brick.size(), samples);
            start.readBox(brick.min, brick.size(), made.data());
            for (std::size_t i = 0; i < made.size(); ++i)
                samples[i] = mTraining.depths().open(samples[i])   ? std::clamp(made[i] * scale, -kFar, kFar)
                             : mTraining.depths().full(samples[i]) ? -kFar
                                                                   : kFar;
        });
        mDensity = densityField(mDistance, mContext);
        const std::size_t count = mVoxels.table.size();
        mSource.assign(count, {});
        mCoherent.assign(count, 0);
        mChanged.assign(count, 0);
        mComputed.assign(count, 0);
        if (mCoarser)
            each(1024, [&](std::size_t i) { mSource[i] = inherited(i); });
        else
            layPatches();
    }

    // Nothing would grow on a plain surface: it resembles the plainest part of the texture everywhere. So the
    // coarsest level begins with patches of the textured model, placed side by side without regard to seams.
    void layPatches() {
        const PatchLayout layout(mVoxels, mPlain, mTraining, mContext);
        each(1024, [&](std::size_t i) { mSource[i] = layout.sourceOf(i); });
        std::vector<float> value(mSource.size());
        each(1024, [&](std::size_t i) {
            value[i] = mSource[i].row < 0
                           ? mDistance.inside(mVoxels.table[i])
                           : std::clamp(readThrough(i, mSource[i], mVoxels.table[i]), -kFar, kFar);
        });
        for (std::size_t i = 0; i < value.size(); ++i) {
            const float density = densityOf(value[i]);
            mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
            mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
        }
    }

    // The source of the coarser level's voxel, offset from its middle as this voxel
    // is from the coarser voxel's.
    AnalogySource inherited(std::size_t i) const {
        const Index3& v = mVoxels.table[i];
        const Index3 parent{v.x >> 1, v.y >> 1, v.z >> 1};
        const std::int32_t c = mCoarser->table.find(parent);
        if (c < 0 || mCoarser->source[std::size_t(c)].pair < 0) return {};
        const Vec3f middle = toFinest(middleOf(parent), 1);
        const Vec3f from = toFinest(mCoarser->sourcePlace[std::size_t(c)], 1) +
                           rotated(mCoarser->frame[std::size_t(c)], mCoarser->sourceFrame[std::size_t(c)],
                                   middleOf(v) - middle);
        const AnalogyRow& row = mCoarser->source[std::size_t(c)];
        const float depth = mPlain.inside(v) - mTraining.plainThrough(row, from);
        return mTraining.sourceAt(row.pair, from + mCoarser->sourceFrame[std::size_t(c)].n * depth);
    }

    // Feature distances of the sources and of the nearest rows.
    void probe(AnalogyLevelStats& stats) const {
        const std::size_t count = std::min(kProbed, mSource.size());
        std::vector<std::pair<float, float>> squared(count);
        parallelFor(mContext, count, 16, [&](std::size_t begin, std::size_t end) {
            std::vector<float> made(mShape.made()), feature(mTraining.reduced().count());
            for (std::size_t k = begin; k < end; ++k) {
                const std::size_t i = k * mSource.size() / count;
                if (mSource[i].row < 0) continue;
                featureOf(i, made, feature);
                squared[k] = {mTraining.index().squaredTo(feature.data(), mSource[i].row),
                              mTraining.index().nearest(feature.data(), kOutside).squared};
            }
        });
        double copied = 0, exact = 0;
        for (const auto& [of, nearest] : squared) {
            copied += double(of);
            exact += double(nearest);
        }
        stats.meanDistance = std::sqrt(copied / double(std::max<std::size_t>(count, 1)));
        stats.exactDistance = std::sqrt(exact / double(std::max<std::size_t>(count, 1)));
    }

    Vec3f placeOf(std::size_t i) const {
        return featurePlace(middleOf(mVoxels.table[i]), mVoxels.frame[i], mPlain.inside(mVoxels.table[i]),
                            mOptions.aligned);
    }

    void featureOf(std::size_t i, std::vector<float>& made, std::vector<float>& feature) const {
        sampleMade(mShape, mDensity, placeOf(i), mVoxels.frame[i], mVoxels.curvature[i], made.data());
        mTraining.reduced().addMade(made.data(), mRest.data() + i * feature.size(), feature.data());
    }

    // Voxels in the order of waves; the beginning of each wave, and the end.
    std::vector<std::size_t> orderWaves() {
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

    void projectRests() {
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

    void runWave(std::size_t first, std::size_t last, bool searched) {
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
            if (mSource[i].row != mFound[k].source.row) mChanged[i] = mNow;
            mSource[i] = mFound[k].source;
            const float distance = std::clamp(mFound[k].distance, -kFar, kFar), density = densityOf(distance);
            mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &distance);
            mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
        }
    }

    // True if a neighbour's source changed since the voxel was last computed; otherwise the search would find
    // the same source again.
    bool changedAround(std::uint32_t i) const {
        if (mChanged[i] >= mComputed[i]) return true;
        for (const Index3& step : kAllNeighbours) {
            const std::int32_t j = mVoxels.table.find(mVoxels.table[i] + step);
            if (j >= 0 && mChanged[std::size_t(j)] >= mComputed[i]) return true;
        }
        return false;
    }

    struct Found {
        AnalogySource source;
        float distance = 0;
        char coherent = 0;
    };

    Found match(std::uint32_t i, bool searched, std::vector<float>& made, std::vector<float>& feature) const {
        const FeatureIndex& index = mTraining.index();
        featureOf(i, made, feature);
        const Candidate best = bestCandidate(i, feature.data());
        Found found;
        found.source = best.source;
        found.coherent = 1;
        // Later sweeps refine the first one's result; only voxels without a candidate search again.
        if (searched || best.source.row < 0) {
            // The nearest row replaces a candidate that continues a neighbour only if
            // it is nearer by this factor.
            const float more = 1 + float(mOptions.coherence) / float(1 << mLevel);
            const float bound = best.source.row < 0 ? kOutside : best.squared / (more * more);
            const FeatureMatch nearest = index.nearest(feature.data(), bound, float(mOptions.epsilon));
            if (nearest.row >= 0) {
                found.source = mTraining.featureSource(nearest.row);
                found.coherent = 0;
            }
        }
        found.distance = readThrough(i, found.source, mVoxels.table[i]);
        return found;
    }

    struct Candidate {
        AnalogySource source;
        float squared = kOutside;
    };

    // The nearest of the candidates that continue the voxel's own source and its neighbours'.
    Candidate bestCandidate(std::uint32_t i, const float* feature) const {
        std::array<std::int32_t, 28> tried;
        std::size_t count = 0;
        Candidate best;
        const auto consider = [&](const AnalogySource& source) {
            const auto end = tried.begin() + std::ptrdiff_t(count);
            if (source.row < 0 || std::find(tried.begin(), end, source.row) != end) return;
            tried[count++] = source.row;
            const float squared = mTraining.index().squaredTo(feature, source.row);
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

    // The source of a voxel's neighbour j, moved to the voxel along the surface and to the voxel's own depth.
    AnalogySource continued(std::size_t i, std::size_t j, const Index3& step) const {
        const AnalogyRow& row = mTraining.row(mSource[j].row);
        const Frame& frame = mTraining.frame(row);
        Vec3f from = mTraining.placeOf(mSource[j]) - rotated(mVoxels.frame[j], frame, middleOf(step));
        from = from + frame.n * (mPlain.inside(mVoxels.table[i]) - mTraining.plainThrough(row, from));
        return mTraining.sourceAt(row.pair, from);
    }

    // The value that a voxel's source proposes for a position: the textured distance, offset from the source
    // in its frame as the position is from the voxel; the source is first moved to the voxel's own depth.
    float readThrough(std::size_t i, const AnalogySource& source, const Index3& place) const {
        const AnalogyRow& row = mTraining.row(source.row);
        return sampleCubic(mTraining.textured(row),
                           atDepth(i, source) + rotated(mVoxels.frame[i], mTraining.frame(row),
                                                        middleOf(place - mVoxels.table[i])));
    }

    // A source moved along its normal to the voxel's own depth.
    Vec3f atDepth(std::size_t i, const AnalogySource& source) const {
        const AnalogyRow& row = mTraining.row(source.row);
        const Vec3f place = mTraining.placeOf(source);
        const float depth =
            std::clamp(mPlain.inside(mVoxels.table[i]) - mTraining.plainThrough(row, place), -1.f, 1.f);
        return place + mTraining.frame(row).n * depth;
    }

    // Means of the proposals of a voxel and its neighbours.
    BrickField voted() {
        std::vector<float> value(mVoxels.table.size());
        each(256, [&](std::size_t i) {
            const Index3& v = mVoxels.table[i];
            float sum = 0, weights = 0;
            forEachVoxel(IndexBox{v, v}.expanded(1), [&](const Index3& p) {
                const std::int32_t j = mVoxels.table.find(p);
                if (j < 0 || mSource[std::size_t(j)].row < 0) return;
                const Index3 offset = p - v;
                const int squared = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
                const float weight = 1 / float(1 + squared);
                sum +=
                    weight * std::clamp(readThrough(std::size_t(j), mSource[std::size_t(j)], v), -kFar, kFar);
                weights += weight;
            });
            value[i] = weights > 0 ? sum / weights : mDistance.inside(v);
        });
        BrickField result = mDistance;
        for (std::size_t i = 0; i < value.size(); ++i)
            result.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
        return result;
    }

    const AnalogyTraining& mTraining;
    const BrickField &mPlain, &mPlainDensity;
    const BrickField* mCoarsePlain;
    FeatureShape mShape;
    const Made* mCoarser;
    const VolumeAnalogyOptions& mOptions;
    const RunContext& mContext;
    int mLevel;
    AnalogyVoxels mVoxels;
    BrickField mDistance, mDensity;  // of the field being synthesised
    std::vector<AnalogySource> mSource;
    std::vector<char> mCoherent;
    std::uint32_t mNow = 0;                          // waves so far
    std::vector<std::uint32_t> mChanged, mComputed;  // the wave in which each voxel last did or was
    std::vector<float> mRest;
    std::vector<std::uint32_t> mOrder;
    std::vector<Found> mFound;
};

void requirePairs(const std::vector<AnalogyPair>& pairs, const BrickField& target) {
    requireOption(!pairs.empty(), "pairs", "0", "at least one");
    for (std::size_t p = 0; p < pairs.size(); ++p) {
        const std::string what = "pair " + std::to_string(p + 1);
        requireField(pairs[p].plain.get(), what + ", plain");
        requireField(pairs[p].textured.get(), what + ", textured", pairs[p].plain->box().size());
        if (!pairs[p].frames) throw Error(ErrorCode::InvalidOption, what + ": `frames` are null");
    }
    requireField(&target, "the target");
}

}  // namespace

void validate(const VolumeAnalogyOptions& options) {
    const auto whole = [](int value, int low, int high, const char* name) {
        requireOption(value >= low && value <= high, name, std::to_string(value),
                      "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    };
    whole(options.levels, 0, 6, "levels");
    whole(options.sweeps, 1, 10, "sweeps");
    whole(options.half, 1, 4, "half");
    whole(options.coarseHalf, 1, 3, "coarseHalf");
    whole(options.components, 4, 256, "components");
    requireOption(options.coherence >= 0 && options.coherence <= 100, "coherence",
                  roundedText(options.coherence, 6), "from 0 to 100");
    requireOption(options.epsilon >= 0 && options.epsilon <= 100, "epsilon", roundedText(options.epsilon, 6),
                  "from 0 to 100");
}

VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& given,
                                const RunContext& ctx) {
    validate(given);
    requirePairs(pairs, target);
    VolumeAnalogyOptions options = given;
    if (options.levels == 0) options.levels = usefulLevels(pairs, ctx);
    std::vector<PairLevels> levels;
    for (const AnalogyPair& pair : pairs)
        levels.push_back({analogyPyramid(*pair.plain, options.levels, ctx),
                          analogyPyramid(*pair.textured, options.levels, ctx)});
    const AnalogyPyramid plain = analogyPyramid(target, options.levels, ctx);
    VolumeAnalogyResult result;
    std::optional<Made> made;
    for (int l = options.levels - 1; l >= 0; --l) {
        const FeatureShape shape{options.half, options.coarseHalf, options.causal, l + 1 < options.levels};
        const AnalogyTraining training(pairs, levels, l, shape, options, ctx);
        Level level(training, plain, frames, l, shape, made ? &*made : nullptr, options, ctx);
        result.levels.push_back(level.run());
        if (l > 0) {
            made = level.made();
        } else {
            result.sources = level.sources();
            result.depths = training.depths().runs();
        }
    }
    return result;
}

}  // namespace vdbsynth
