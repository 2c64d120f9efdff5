// How a level begins, and what it passes on.
#include "libvdbsynth/analogy/volume_analogy_level_steps.h"

#include "libvdbsynth/grid/pyramid.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {

AnalogyLevel::AnalogyLevel(const AnalogyTraining& training, const AnalogyPyramid& target,
                           const FrameField& frames, int level, const FeatureShape& shape,
                           const AnalogyLevelResult* coarser, const VolumeAnalogyOptions& options,
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

AnalogyLevelResult AnalogyLevel::made() {
    AnalogyLevelResult result;
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

ElementSources AnalogyLevel::sources() const {
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

void AnalogyLevel::begin() {
    const BrickField start = mCoarser ? doubled(mCoarser->distance, mPlain.box().size(), mContext) : mPlain;
    const float scale = mCoarser ? 2.f : 1.f;
    mDistance = BrickField::generate(mPlain.box(), mContext, [&](const IndexBox& brick, float* samples) {
        std::array<float, BrickField::kSamples> made;
        mPlain.readBox(brick.min, brick.size(), samples);
        start.readBox(brick.min, brick.size(), made.data());
        for (std::size_t i = 0; i < made.size(); ++i)
            samples[i] = mTraining.depths().open(samples[i])
                             ? std::clamp(made[i] * scale, -kAnalogyFar, kAnalogyFar)
                         : mTraining.depths().full(samples[i]) ? -kAnalogyFar
                                                               : kAnalogyFar;
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
    readSources();
    countSources();
}

void AnalogyLevel::layPatches() {
    const PatchLayout layout(mVoxels, mPlain, mTraining, mContext);
    each(1024, [&](std::size_t i) { mSource[i] = layout.sourceOf(i); });
}

void AnalogyLevel::readSources() {
    std::vector<float> value(mSource.size());
    each(1024, [&](std::size_t i) {
        value[i] = mSource[i].row < 0
                       ? mDistance.inside(mVoxels.table[i])
                       : std::clamp(readThrough(i, mSource[i], mVoxels.table[i]), -kAnalogyFar, kAnalogyFar);
    });
    for (std::size_t i = 0; i < value.size(); ++i) {
        const float density = densityOf(value[i]);
        mDistance.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
        mDensity.writeBox(mVoxels.table[i], {1, 1, 1}, &density);
    }
}

void AnalogyLevel::countSources() {
    std::vector<SourceUsage::Row> rows(mTraining.size());
    for (std::size_t r = 0; r < rows.size(); ++r) {
        const AnalogyRow& row = mTraining.row(std::int32_t(r));
        rows[r] = {row.pair, mTraining.voxel(row)};
    }
    mUsage = SourceUsage(rows, mSource.size());
    for (const AnalogySource& source : mSource) mUsage.change(-1, source.row);
}

AnalogySource AnalogyLevel::inherited(std::size_t i) const {
    const Index3& v = mVoxels.table[i];
    const Index3 parent{v.x >> 1, v.y >> 1, v.z >> 1};
    const std::int32_t c = mCoarser->table.find(parent);
    if (c < 0 || mCoarser->source[std::size_t(c)].pair < 0) return {};
    const Vec3f middle = toFinest(middleOf(parent), 1);
    const Vec3f from =
        toFinest(mCoarser->sourcePlace[std::size_t(c)], 1) +
        rotated(mCoarser->frame[std::size_t(c)], mCoarser->sourceFrame[std::size_t(c)], middleOf(v) - middle);
    const AnalogyRow& row = mCoarser->source[std::size_t(c)];
    const float depth = mPlain.inside(v) - mTraining.plainThrough(row, from);
    return mTraining.sourceAt(row.pair, from + mCoarser->sourceFrame[std::size_t(c)].n * depth);
}

void AnalogyLevel::probe(AnalogyLevelStats& stats) const {
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

float AnalogyLevel::readThrough(std::size_t i, const AnalogySource& source, const Index3& place) const {
    const AnalogyRow& row = mTraining.row(source.row);
    return sampleCubic(mTraining.textured(row),
                       atDepth(i, source) + rotated(mVoxels.frame[i], mTraining.frame(row),
                                                    middleOf(place - mVoxels.table[i])));
}

Vec3f AnalogyLevel::atDepth(std::size_t i, const AnalogySource& source) const {
    const AnalogyRow& row = mTraining.row(source.row);
    const Vec3f place = mTraining.placeOf(source);
    const float depth =
        std::clamp(mPlain.inside(mVoxels.table[i]) - mTraining.plainThrough(row, place), -1.f, 1.f);
    return place + mTraining.frame(row).n * depth;
}

BrickField AnalogyLevel::voted() {
    std::vector<float> value(mVoxels.table.size());
    each(256, [&](std::size_t i) {
        const Index3& v = mVoxels.table[i];
        float sum = 0, weights = 0;
        forEachVoxel(IndexBox{v, v}.expanded(1), [&](const Index3& p) {
            const std::int32_t j = mVoxels.table.find(p);
            if (j < 0 || mSource[std::size_t(j)].row < 0) return;
            const Index3 offset = p - v;
            const int squared = offset.x * offset.x + offset.y * offset.y + offset.z * offset.z;
            const float weight = 1 / float((1 + squared) * (1 + squared));
            sum += weight * std::clamp(readThrough(std::size_t(j), mSource[std::size_t(j)], v), -kAnalogyFar,
                                       kAnalogyFar);
            weights += weight;
        });
        value[i] = weights > 0 ? sum / weights : mDistance.inside(v);
    });
    BrickField result = mDistance;
    for (std::size_t i = 0; i < value.size(); ++i) result.writeBox(mVoxels.table[i], {1, 1, 1}, &value[i]);
    return result;
}

}  // namespace vdbsynth
