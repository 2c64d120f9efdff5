#include "libvdbsynth/synth/volume_analogy.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/base/parallel_sort.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/search/feature_index.h"
#include "libvdbsynth/synth/analogy_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace vdbsynth {
namespace {

constexpr float kFar = 6;               // [voxels] of what is not near the result's surface
constexpr std::size_t kLearned = 6000;  // features that the principal axes are made from
constexpr double kShare = 0.9999;       // of their variance
constexpr float kOutside = 1e9f;        // marks voxels that are no source
constexpr float kWave = 0.5f;           // [voxels of the level] of sweep distance

Vec3f middleOf(const Index3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}
Vec3f turned(const Frame& from, const Frame& to, const Vec3f& v) {
    return to.t * dot(from.t, v) + to.n * dot(from.n, v) + to.b * dot(from.b, v);
}
// Places are never far below 0, and rounding by a library call is a tenth of a sweep.
Index3 nearestVoxel(const Vec3f& p) {
    constexpr int kUp = 1024;
    const auto round = [](float v) { return int(v + (float(kUp) + 0.5f)) - kUp; };
    return {round(p.x), round(p.y), round(p.z)};
}

// One pair at all levels.
struct PairLevels {
    AnalogyPyramid plain, textured;
};

// A voxel of a pair that may be copied.
struct Row {
    std::int32_t pair, voxel;
};

// The pairs at one level: every voxel that may be copied, with its feature.
class Training {
public:
    Training(const std::vector<AnalogyPair>& pairs, const std::vector<PairLevels>& levels, int level,
             const FeatureShape& shape, const VolumeAnalogyOptions& options, const RunContext& ctx)
        : mLevels(levels), mLevel(level), mShape(shape), mDepths(shape.half) {
        for (std::size_t p = 0; p < pairs.size(); ++p) addDepths(pairs[p], p);
        mDepths.finish();
        for (std::size_t p = 0; p < pairs.size(); ++p) addRows(pairs[p], p, options.aligned, ctx);
        if (mRows.empty())
            throw Error(ErrorCode::Unusable, "the pair is too small for neighbourhoods of " +
                                                 std::to_string(2 * shape.half + 1) + " voxels at level " +
                                                 std::to_string(level + 1) +
                                                 "; use fewer --levels, or a larger or finer pair");
        learn(options, ctx);
    }

    const DepthClasses& depths() const { return mDepths; }
    const FeatureIndex& index() const { return *mIndex; }
    const ReducedFeatures& reduced() const { return mReduced; }
    const PrincipalAxes& axes() const { return mAxes; }
    const Row& row(std::int32_t r) const { return mRows[std::size_t(r)]; }
    const Frame& frame(const Row& r) const {
        return mVoxels[std::size_t(r.pair)].frame[std::size_t(r.voxel)];
    }
    Index3 voxel(const Row& r) const { return mVoxels[std::size_t(r.pair)].table[std::size_t(r.voxel)]; }
    float plainAt(const Row& r) const {
        return mLevels[std::size_t(r.pair)].plain.distance[std::size_t(mLevel)].inside(voxel(r));
    }
    // The plain distance at a place of the row's pair.
    float plainThrough(const Row& r, const Vec3f& at) const {
        return sampleTrilinear(mLevels[std::size_t(r.pair)].plain.distance[std::size_t(mLevel)], at);
    }
    const BrickField& textured(const Row& r) const {
        return mLevels[std::size_t(r.pair)].textured.distance[std::size_t(mLevel)];
    }
    std::size_t size() const { return mRows.size(); }
    // Half as far as a patch can go on from the middle of a pair.
    int patchReach(std::int32_t pair) const {
        Index3 size = mInner[std::size_t(pair)].size();
        if (size.x > size.y) std::swap(size.x, size.y);
        if (size.y > size.z) std::swap(size.y, size.z);
        return std::clamp(std::max(size.x, size.y) / 3, 3, 24);
    }
    // The row of a voxel, negative if it may not be copied.
    std::int32_t find(std::int32_t pair, const Index3& p) const {
        const std::int32_t voxel = mVoxels[std::size_t(pair)].table.find(p);
        return voxel < 0 ? -1 : mFirst[std::size_t(pair)] + voxel;
    }

private:
    // What is inside `inner` at this level; a margin keeps features inside.
    IndexBox innerAt(const AnalogyPair& pair, int margin) const {
        const int scale = 1 << mLevel;
        IndexBox box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = (pair.inner.min[axis] + scale - 1) / scale + margin;
            box.max[axis] = (pair.inner.max[axis] + 1) / scale - 1 - margin;
        }
        return box;
    }

    void addDepths(const AnalogyPair& pair, std::size_t p) {
        const BrickField &plain = mLevels[p].plain.distance[std::size_t(mLevel)],
                         &textured = mLevels[p].textured.distance[std::size_t(mLevel)];
        const IndexBox box = innerAt(pair, 0).intersection(plain.box());
        if (box.empty()) return;
        std::vector<float> a(std::size_t(box.size().z)), b(a.size());
        for (int x = box.min.x; x <= box.max.x; ++x)
            for (int y = box.min.y; y <= box.max.y; ++y) {
                plain.readBox({x, y, box.min.z}, {1, 1, box.size().z}, a.data());
                textured.readBox({x, y, box.min.z}, {1, 1, box.size().z}, b.data());
                for (std::size_t z = 0; z < a.size(); ++z) mDepths.add(a[z], b[z]);
            }
    }

    void addRows(const AnalogyPair& pair, std::size_t p, bool aligned, const RunContext& ctx) {
        const BrickField& plain = mLevels[p].plain.distance[std::size_t(mLevel)];
        const int margin =
            mShape.coarse ? std::max(mShape.half + 1, 2 * mShape.coarseHalf + 2) : mShape.half + 1;
        const IndexBox box = innerAt(pair, margin);
        mInner.push_back(box);
        const BrickField sources =
            BrickField::generate(plain.box(), ctx, [&](const IndexBox& brick, float* samples) {
                plain.readBox(brick.min, brick.size(), samples);
                for (int i = 0; i < BrickField::kSamples; ++i)
                    if (!box.contains(brick.min + Index3{i >> 6, (i >> 3) & 7, i & 7})) samples[i] = kOutside;
            });
        VoxelTable table = VoxelTable::where(
            sources, [&](float d) { return d < kOutside && mDepths.open(d); }, ctx);
        mFirst.push_back(std::int32_t(mRows.size()));
        for (std::size_t v = 0; v < table.size(); ++v) mRows.push_back({std::int32_t(p), std::int32_t(v)});
        mVoxels.push_back(analogyVoxels(std::move(table), *pair.frames, mLevel, aligned, ctx));
    }

    void sample(std::size_t r, float* out) const {
        const Row& row = mRows[r];
        const PairLevels& of = mLevels[std::size_t(row.pair)];
        const std::size_t l = std::size_t(mLevel);
        const Vec3f at = middleOf(voxel(row));
        sampleMade(mShape, of.textured.density[l], at, frame(row), out);
        FeatureFields fields{&of.plain.density[l], nullptr, nullptr};
        if (mShape.coarse) {
            fields.coarsePlain = &of.plain.density[l + 1];
            fields.coarseTextured = &of.textured.density[l + 1];
        }
        sampleRest(mShape, fields, at, frame(row), out + mShape.made());
    }

    void learn(const VolumeAnalogyOptions& options, const RunContext& ctx) {
        const std::size_t size = mShape.size(), learned = std::min(kLearned, mRows.size());
        std::vector<float> some(learned * size);
        parallelFor(ctx, learned, 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                sample(i * mRows.size() / learned, some.data() + i * size);
        });
        mAxes = principalAxes(some, size, std::size_t(options.components), kShare);
        mReduced = ReducedFeatures(mShape, mAxes);
        const std::size_t count = mReduced.count();
        std::vector<float> features(mRows.size() * count);
        parallelFor(ctx, mRows.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::vector<float> feature(size), rest(count);
            for (std::size_t r = begin; r < end; ++r) {
                sample(r, feature.data());
                mReduced.ofRest(feature.data() + mShape.made(), plainAt(mRows[r]), rest.data());
                mReduced.addMade(feature.data(), rest.data(), features.data() + r * count);
            }
        });
        mIndex.emplace(std::move(features), count);
    }

    const std::vector<PairLevels>& mLevels;
    int mLevel;
    FeatureShape mShape;
    DepthClasses mDepths;
    std::vector<Row> mRows;
    std::vector<std::int32_t> mFirst;    // row of each pair's first voxel
    std::vector<AnalogyVoxels> mVoxels;  // of each pair
    std::vector<IndexBox> mInner;        // of each pair, what may be copied
    PrincipalAxes mAxes;
    ReducedFeatures mReduced;
    std::optional<FeatureIndex> mIndex;
};

// Patches of the pairs over a target's surface: each begins at a place drawn at random with a source drawn at
// random, and goes on from neighbour to neighbour, in both surfaces' frames, until it is as large as the pair
// allows or meets another. What lies above and below takes the source of the surface's voxel beneath it, at
// its own depth.
class PatchLayout {
public:
    PatchLayout(const AnalogyVoxels& voxels, const BrickField& plain, const Training& training,
                const RunContext& ctx)
        : mVoxels(voxels), mPlain(plain), mTraining(training), mPlaced(voxels.table.size()) {
        std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
        for (std::uint32_t i = 0; i < mPlaced.size(); ++i)
            if (onSurface(i)) order.push_back({hash64(&i, sizeof i, ctx.seed), i});
        std::sort(order.begin(), order.end());
        std::vector<std::int32_t> seeds;
        for (std::size_t r = 0; r < training.size(); ++r)
            if (std::abs(training.plainAt(training.row(std::int32_t(r)))) < kSurface)
                seeds.push_back(std::int32_t(r));
        if (seeds.empty()) return;
        for (const auto& [key, i] : order)
            if (mPlaced[i].pair < 0) grow(i, seeds[std::size_t(key % seeds.size())]);
    }

    // Negative where no patch says anything.
    std::int32_t rowOf(std::size_t i) const {
        const Index3& v = mVoxels.table[i];
        const float depth = mPlain.inside(v);
        const Vec3f foot = middleOf(v) - mVoxels.frame[i].n * depth;
        const Index3 base = nearestVoxel(foot);
        std::int32_t nearest = -1;
        float best = 1e9f;
        for (int k = 0; k < 27; ++k) {
            const std::int32_t j = mVoxels.table.find(base + Index3{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1});
            if (j < 0 || mPlaced[std::size_t(j)].pair < 0) continue;
            const Vec3f offset = middleOf(mVoxels.table[std::size_t(j)]) - foot;
            if (dot(offset, offset) >= best) continue;
            best = dot(offset, offset);
            nearest = j;
        }
        if (nearest < 0) return -1;
        const Placed& placed = mPlaced[std::size_t(nearest)];
        const Frame& frame = mTraining.frame(mTraining.row(placed.row));
        const Vec3f beside = turned(mVoxels.frame[std::size_t(nearest)], frame,
                                    foot - middleOf(mVoxels.table[std::size_t(nearest)]));
        const Vec3f at = placed.at + (beside - frame.n * dot(frame.n, beside)) +
                         frame.n * (depth - mTraining.plainAt(mTraining.row(placed.row)));
        return mTraining.find(placed.pair, nearestVoxel(at));
    }

private:
    static constexpr float kSurface = 0.9f;  // [voxels]
    struct Placed {
        std::int32_t pair = -1, row = -1;
        Vec3f at;
    };

    bool onSurface(std::size_t i) const { return std::abs(mPlain.inside(mVoxels.table[i])) < kSurface; }

    void grow(std::uint32_t first, std::int32_t seed) {
        const Row& begin = mTraining.row(seed);
        const int reach = mTraining.patchReach(begin.pair);
        mPlaced[first] = {begin.pair, seed, middleOf(mTraining.voxel(begin))};
        std::vector<std::pair<std::uint32_t, int>> queue{{first, 0}};
        for (std::size_t next = 0; next < queue.size(); ++next) {
            const auto [i, steps] = queue[next];
            if (steps == reach) continue;
            const Placed from = mPlaced[i];
            const Frame& frame = mTraining.frame(mTraining.row(from.row));
            for (int k = 0; k < 27; ++k) {
                const Index3 offset{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
                const std::int32_t j = mVoxels.table.find(mVoxels.table[i] + offset);
                if (j < 0 || mPlaced[std::size_t(j)].pair >= 0 || !onSurface(std::size_t(j)) ||
                    dot(mVoxels.frame[i].n, mVoxels.frame[std::size_t(j)].n) <= 0)
                    continue;
                Vec3f at = from.at + turned(mVoxels.frame[i], frame, middleOf(offset));
                std::int32_t row = mTraining.find(from.pair, nearestVoxel(at));
                if (row < 0) continue;
                // Back to the depth of the voxel, which steps along a tangent leave.
                const Row& source = mTraining.row(row);
                at = at + mTraining.frame(source).n * (mPlain.inside(mVoxels.table[std::size_t(j)]) -
                                                       mTraining.plainThrough(source, at));
                row = mTraining.find(from.pair, nearestVoxel(at));
                if (row < 0) continue;
                mPlaced[std::size_t(j)] = {from.pair, row, at};
                queue.push_back({std::uint32_t(j), steps + 1});
            }
        }
    }

    const AnalogyVoxels& mVoxels;
    const BrickField& mPlain;
    const Training& mTraining;
    std::vector<Placed> mPlaced;  // of voxels on the surface
};

// What a level leaves to the next finer one.
struct Made {
    BrickField distance, density;
    VoxelTable table;
    std::vector<Frame> frame;
    std::vector<Row> source;  // pair -1: none
    std::vector<Index3> sourceVoxel;
    std::vector<Frame> sourceFrame;
};

// The target at one level.
class Level {
public:
    Level(const Training& training, const AnalogyPyramid& target, const FrameField& frames, int level,
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
                                frames, level, options.aligned, ctx);
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
        double squares = 0;
        std::size_t coherent = 0;
        for (std::size_t i = 0; i < mSource.size(); ++i) {
            squares += double(mSquared[i]);
            coherent += std::size_t(mCoherent[i]);
        }
        const double count = double(std::max<std::size_t>(mSource.size(), 1));
        stats.meanDistance = std::sqrt(squares / count);
        stats.coherent = double(coherent) / count;
        return stats;
    }

    Made made() {
        Made result;
        result.distance = voted();
        result.density = densityField(result.distance, mContext);
        for (std::int32_t row : mSource) {
            const Row source = row < 0 ? Row{-1, -1} : mTraining.row(row);
            result.source.push_back(source);
            result.sourceVoxel.push_back(row < 0 ? Index3{} : mTraining.voxel(source));
            result.sourceFrame.push_back(row < 0 ? Frame{} : mTraining.frame(source));
        }
        result.frame = mVoxels.frame;
        result.table = mVoxels.table;
        return result;
    }

private:
    template <typename Work>
    void each(std::size_t grain, Work&& work) {
        parallelFor(mContext, mVoxels.table.size(), grain, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) work(i);
        });
    }

    // Where nothing has to be worked out, full or empty; else the plain target, or what the coarser level
    // made.
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
        mSource.assign(count, -1);
        mSquared.assign(count, 0);
        mCoherent.assign(count, 0);
        mChanged.assign(count, 0);
        mWorkedOut.assign(count, 0);
        if (mCoarser)
            each(1024, [&](std::size_t i) { mSource[i] = inherited(i); });
        else
            layPatches();
    }

    // Nothing grows on a plain surface: it looks like the plainest place of the texture, everywhere. So the
    // coarsest level begins with patches of the textured model, laid side by side without regard to joints.
    void layPatches() {
        const PatchLayout layout(mVoxels, mPlain, mTraining, mContext);
        each(1024, [&](std::size_t i) { mSource[i] = layout.rowOf(i); });
        std::vector<float> value(mSource.size());
        each(1024, [&](std::size_t i) {
            value[i] = mSource[i] < 0 ? mDistance.inside(mVoxels.table[i])
                                      : std::clamp(readThrough(i, mSource[i], mVoxels.table[i]), -kFar, kFar);
        });
        for (std::size_t i = 0; i < value.size(); ++i) {
            const float density = densityOf(value[i]);
            mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
            mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
        }
    }

    // What the coarser level's voxel copied, as far from its middle as this one is from the coarser voxel's.
    std::int32_t inherited(std::size_t i) const {
        const Index3& v = mVoxels.table[i];
        const Index3 parent{v.x >> 1, v.y >> 1, v.z >> 1};
        const std::int32_t c = mCoarser->table.find(parent);
        if (c < 0 || mCoarser->source[std::size_t(c)].pair < 0) return -1;
        const Vec3f middle = toFinest(middleOf(parent), 1);
        const Vec3f from = toFinest(middleOf(mCoarser->sourceVoxel[std::size_t(c)]), 1) +
                           turned(mCoarser->frame[std::size_t(c)], mCoarser->sourceFrame[std::size_t(c)],
                                  middleOf(v) - middle);
        return mTraining.find(mCoarser->source[std::size_t(c)].pair, nearestVoxel(from));
    }

    // Voxels in the order of waves; where each wave begins, and the end.
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
                sampleRest(mShape, fields, middleOf(mVoxels.table[i]), mVoxels.frame[i], rest.data());
                mTraining.reduced().ofRest(rest.data(), mPlain.inside(mVoxels.table[i]),
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
            if (mFound[k].row < 0) continue;
            const std::uint32_t i = mOrder[first + k];
            mWorkedOut[i] = mNow;
            mSquared[i] = mFound[k].squared;
            if (mSource[i] == mFound[k].row && !searched) continue;
            mCoherent[i] = mFound[k].coherent;
            if (mSource[i] != mFound[k].row) mChanged[i] = mNow;
            mSource[i] = mFound[k].row;
            const float distance = std::clamp(mFound[k].distance, -kFar, kFar), density = densityOf(distance);
            mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &distance);
            mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
        }
    }

    // Whether one of a voxel's neighbours has another source than when it was last worked out; if none has,
    // it would find again what it has.
    bool changedAround(std::uint32_t i) const {
        for (int k = 0; k < 27; ++k) {
            const std::int32_t j =
                mVoxels.table.find(mVoxels.table[i] + Index3{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1});
            if (j >= 0 && mChanged[std::size_t(j)] >= mWorkedOut[i]) return true;
        }
        return false;
    }

    struct Found {
        std::int32_t row = -1;
        float squared = 0, distance = 0;
        char coherent = 0;
    };

    Found match(std::uint32_t i, bool searched, std::vector<float>& made, std::vector<float>& feature) const {
        const FeatureIndex& index = mTraining.index();
        sampleMade(mShape, mDensity, middleOf(mVoxels.table[i]), mVoxels.frame[i], made.data());
        mTraining.reduced().addMade(made.data(), mRest.data() + i * feature.size(), feature.data());
        FeatureMatch best = bestCandidate(i, feature.data());
        Found found;
        found.row = best.row;
        found.squared = best.squared;
        found.coherent = 1;
        // Later sweeps settle what the first one found; only what has no candidate searches again.
        if (searched || best.row < 0) {
            // Farther than what goes on from a neighbour, the nearest of all is not worth a break.
            const float more = 1 + float(mOptions.coherence) / float(1 << mLevel);
            const float bound = best.row < 0 ? kOutside : best.squared / (more * more);
            const FeatureMatch nearest = index.nearest(feature.data(), bound, float(mOptions.slack));
            if (nearest.row >= 0) {
                found.row = nearest.row;
                found.squared = nearest.squared;
                found.coherent = 0;
            }
        }
        found.distance = readThrough(i, found.row, mVoxels.table[i]);
        return found;
    }

    // The nearest of those that go on from what the voxel itself and its neighbours copied.
    FeatureMatch bestCandidate(std::uint32_t i, const float* feature) const {
        std::array<std::int32_t, 28> tried;
        std::size_t count = 0;
        FeatureMatch best{-1, kOutside};
        const Index3& v = mVoxels.table[i];
        for (int k = 0; k < 27; ++k) {
            const Index3 offset{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
            const std::int32_t j = k == 13 ? std::int32_t(i) : mVoxels.table.find(v + offset);
            if (j < 0 || mSource[std::size_t(j)] < 0) continue;
            std::int32_t row = mSource[std::size_t(j)];
            if (k != 13) {
                const Row& source = mTraining.row(row);
                const Vec3f from =
                    middleOf(mTraining.voxel(source)) -
                    turned(mVoxels.frame[std::size_t(j)], mTraining.frame(source), middleOf(offset));
                row = mTraining.find(source.pair, nearestVoxel(from));
                if (row < 0) continue;
            }
            if (std::find(tried.begin(), tried.begin() + std::ptrdiff_t(count), row) !=
                tried.begin() + std::ptrdiff_t(count))
                continue;
            tried[count++] = row;
            const float squared = mTraining.index().squaredTo(feature, row);
            if (squared < best.squared || (squared == best.squared && row < best.row)) best = {row, squared};
        }
        return best;
    }

    // What a voxel's source says about a place: the textured distance as far from the source, in its frame,
    // as the place is from the voxel; the source first moved to the voxel's own depth.
    float readThrough(std::size_t i, std::int32_t row, const Index3& place) const {
        const Row& source = mTraining.row(row);
        const Frame& frame = mTraining.frame(source);
        const float depth =
            std::clamp(mPlain.inside(mVoxels.table[i]) - mTraining.plainAt(source), -1.f, 1.f);
        const Vec3f at = middleOf(mTraining.voxel(source)) + frame.n * depth +
                         turned(mVoxels.frame[i], frame, middleOf(place - mVoxels.table[i]));
        return sampleTrilinear(mTraining.textured(source), at);
    }

    // Means of what a voxel and its neighbours say about it.
    BrickField voted() {
        std::vector<float> value(mVoxels.table.size());
        each(256, [&](std::size_t i) {
            const Index3& v = mVoxels.table[i];
            float sum = 0, weights = 0;
            for (int k = 0; k < 27; ++k) {
                const Index3 offset{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
                const std::int32_t j = mVoxels.table.find(v + offset);
                if (j < 0 || mSource[std::size_t(j)] < 0) continue;
                const int squared = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
                const float weight = 1 / float(1 + squared);
                sum +=
                    weight * std::clamp(readThrough(std::size_t(j), mSource[std::size_t(j)], v), -kFar, kFar);
                weights += weight;
            }
            value[i] = weights > 0 ? sum / weights : mDistance.inside(v);
        });
        BrickField result = mDistance;
        for (std::size_t i = 0; i < value.size(); ++i)
            result.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
        return result;
    }

    const Training& mTraining;
    const BrickField &mPlain, &mPlainDensity;
    const BrickField* mCoarsePlain;
    FeatureShape mShape;
    const Made* mCoarser;
    const VolumeAnalogyOptions& mOptions;
    const RunContext& mContext;
    int mLevel;
    AnalogyVoxels mVoxels;
    BrickField mDistance, mDensity;  // of what is being made
    std::vector<std::int32_t> mSource;
    std::vector<float> mSquared;
    std::vector<char> mCoherent;
    std::uint32_t mNow = 0;                           // waves so far
    std::vector<std::uint32_t> mChanged, mWorkedOut;  // the wave in which each voxel last did
    std::vector<float> mRest;
    std::vector<std::uint32_t> mOrder;
    std::vector<Found> mFound;
};

void checkOptions(const VolumeAnalogyOptions& options) {
    const auto whole = [](int value, int low, int high, const char* name) {
        requireOption(value >= low && value <= high, name, std::to_string(value),
                      "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    };
    whole(options.levels, 0, 6, "levels");
    whole(options.sweeps, 0, 10, "sweeps");
    whole(options.half, 1, 4, "neighbourhood");
    whole(options.coarseHalf, 1, 3, "coarse-neighbourhood");
    whole(options.components, 4, 256, "components");
    requireOption(options.coherence >= 0 && options.coherence <= 100, "coherence",
                  std::to_string(options.coherence), "from 0 to 100");
    requireOption(options.slack >= 0 && options.slack <= 100, "slack", std::to_string(options.slack),
                  "from 0 to 100");
}

}  // namespace

namespace {

// Volume that one of two models has and the other has not, in voxels of the finest level.
double textureOf(const BrickField& plain, const BrickField& textured, int level) {
    const Index3 size = plain.box().size();
    std::vector<float> a(std::size_t(size.y) * std::size_t(size.z)), b(a.size());
    double sum = 0;
    for (int x = 0; x < size.x; ++x) {
        plain.readBox({x, 0, 0}, {1, size.y, size.z}, a.data());
        textured.readBox({x, 0, 0}, {1, size.y, size.z}, b.data());
        for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] < 0) != (b[i] < 0);
    }
    return sum * double(1 << (3 * level));
}

}  // namespace

int usefulLevels(const std::vector<AnalogyPair>& pairs, const RunContext& ctx) {
    constexpr int kMost = 3;
    std::array<double, kMost> sums{};
    for (const AnalogyPair& pair : pairs) {
        const AnalogyPyramid plain = analogyPyramid(*pair.plain, kMost, ctx),
                             textured = analogyPyramid(*pair.textured, kMost, ctx);
        for (int l = 0; l < kMost; ++l)
            sums[std::size_t(l)] +=
                textureOf(plain.distance[std::size_t(l)], textured.distance[std::size_t(l)], l);
    }
    int levels = 1;
    while (levels < kMost && sums[std::size_t(levels)] >= kHeld * sums[0]) ++levels;
    message(ctx, MessageLevel::Detail,
            "coarser levels hold " + std::to_string(sums[1] / std::max(sums[0], 1.0)) + " and " +
                std::to_string(sums[2] / std::max(sums[0], 1.0)) +
                " of the texture: " + std::to_string(levels) + " levels");
    return levels;
}

VolumeAnalogyResult makeAnalogy(const std::vector<AnalogyPair>& pairs, const BrickField& target,
                                const FrameField& frames, const VolumeAnalogyOptions& given,
                                const RunContext& ctx) {
    checkOptions(given);
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
        const Training training(pairs, levels, l, shape, options, ctx);
        Level level(training, plain, frames, l, shape, made ? &*made : nullptr, options, ctx);
        result.levels.push_back(level.run());
        made = level.made();
    }
    for (std::size_t i = 0; i < made->source.size(); ++i)
        if (made->source[i].pair >= 0)
            result.sources.push_back({made->table[i], made->sourceVoxel[i], made->source[i].pair});
    result.distance = std::move(made->distance);
    return result;
}

}  // namespace vdbsynth
