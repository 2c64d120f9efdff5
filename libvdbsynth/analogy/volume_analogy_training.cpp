#include "libvdbsynth/analogy/volume_analogy_steps.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/base/parallel.h"

#include <algorithm>
#include <string>

namespace vdbsynth {
namespace {

constexpr std::size_t kLearned = 6000;  // features used to compute the principal axes
constexpr double kShare = 0.9999;       // of their variance

}  // namespace

AnalogyTraining::AnalogyTraining(const std::vector<AnalogyPair>& pairs, const std::vector<PairLevels>& levels,
                                 int level, const FeatureShape& shape, const VolumeAnalogyOptions& options,
                                 const RunContext& ctx)
    : mLevels(levels), mLevel(level), mShape(shape), mAligned(options.aligned), mDepths(shape.half) {
    for (std::size_t p = 0; p < pairs.size(); ++p) addDepths(pairs[p], p);
    mDepths.finish();
    for (std::size_t p = 0; p < pairs.size(); ++p) addRows(pairs[p], p, options, ctx);
    if (mRows.empty())
        throw Error(ErrorCode::Unusable, "the pair is too small for neighbourhoods of " +
                                             std::to_string(2 * shape.half + 1) + " voxels at level " +
                                             std::to_string(level + 1) +
                                             "; use fewer `levels`, or a larger or finer pair");
    learn(options, ctx);
}

AnalogySource AnalogyTraining::featureSource(std::int32_t r) const {
    constexpr std::uint64_t kPlacePurpose = 0x666561747572;
    if (!mAligned) return {r, {0, 0, 0}};
    const AnalogyRow& of = row(r);
    const Index3& at = voxel(of);
    const std::uint64_t key = hash64(&at, sizeof at, kPlacePurpose);
    const auto share = [](std::uint64_t bits) { return float(bits & 0xffff) / 65536.f - 0.5f; };
    const Frame& axes = frame(of);
    const Vec3f beside = axes.t * share(key) + axes.b * share(key >> 16);
    const Vec3f place = middleOf(at) + beside;
    return {r, featurePlace(place, axes, plainThrough(of, place), true) - middleOf(at)};
}

int AnalogyTraining::patchReach(std::int32_t pair) const {
    Index3 size = mInner[std::size_t(pair)].size();
    if (size.x > size.y) std::swap(size.x, size.y);
    if (size.y > size.z) std::swap(size.y, size.z);
    return std::clamp(std::max(size.x, size.y) / 3, 3, 24);
}

// The part of `inner` at this level, shrunk by a margin that keeps features inside.
IndexBox AnalogyTraining::innerAt(const AnalogyPair& pair, int margin) const {
    const int scale = 1 << mLevel;
    IndexBox box;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = (pair.inner.min[axis] + scale - 1) / scale + margin;
        box.max[axis] = (pair.inner.max[axis] + 1) / scale - 1 - margin;
    }
    return box;
}

void AnalogyTraining::addDepths(const AnalogyPair& pair, std::size_t p) {
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

void AnalogyTraining::addRows(const AnalogyPair& pair, std::size_t p, const VolumeAnalogyOptions& options,
                              const RunContext& ctx) {
    const BrickField& plain = mLevels[p].plain.distance[std::size_t(mLevel)];
    const int margin = mShape.coarse ? std::max(mShape.half + 1, 2 * mShape.coarseHalf + 2)
                                     : mShape.half + 1 + int(options.curvatureAdapted);
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
    mVoxels.push_back(analogyVoxels(std::move(table), *pair.frames, mLevel, options.aligned,
                                    options.curvatureAdapted, ctx));
}

void AnalogyTraining::sample(std::size_t r, float* out) const {
    const AnalogyRow& row = mRows[r];
    const PairLevels& of = mLevels[std::size_t(row.pair)];
    const std::size_t l = std::size_t(mLevel);
    const Vec3f at = placeOf(featureSource(std::int32_t(r)));
    const Curvature& curvature = mVoxels[std::size_t(row.pair)].curvature[std::size_t(row.voxel)];
    sampleMade(mShape, of.textured.density[l], at, frame(row), curvature, out);
    FeatureFields fields{&of.plain.density[l], nullptr, nullptr};
    if (mShape.coarse) {
        fields.coarsePlain = &of.plain.density[l + 1];
        fields.coarseTextured = &of.textured.density[l + 1];
    }
    sampleRest(mShape, fields, at, frame(row), curvature, out + mShape.made());
}

void AnalogyTraining::learn(const VolumeAnalogyOptions& options, const RunContext& ctx) {
    const std::size_t size = mShape.size(), learned = std::min(kLearned, mRows.size());
    std::vector<float> some(learned * size);
    parallelFor(ctx, learned, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) sample(i * mRows.size() / learned, some.data() + i * size);
    });
    mAxes = principalAxes(some, size, std::size_t(options.components), kShare);
    mReduced = ReducedFeatures(mShape, mAxes);
    const std::size_t count = mReduced.count();
    std::vector<float> features(mRows.size() * count);
    parallelFor(ctx, mRows.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::vector<float> feature(size), rest(count);
        for (std::size_t r = begin; r < end; ++r) {
            sample(r, feature.data());
            mReduced.ofRest(feature.data() + mShape.made(), featureDepth(plainAt(mRows[r]), mAligned),
                            rest.data());
            mReduced.addMade(feature.data(), rest.data(), features.data() + r * count);
        }
    });
    mIndex.emplace(std::move(features), count);
}

}  // namespace vdbsynth
