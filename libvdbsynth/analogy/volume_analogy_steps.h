#pragma once
#include "libvdbsynth/analogy/analogy_features.h"
#include "libvdbsynth/analogy/volume_analogy.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/search/feature_index.h"

#include <cmath>
#include <optional>
#include <vector>

// Steps of volume_analogy; for its .cpp files only.
namespace vdbsynth {

inline constexpr float kOutside = 1e9f;  // marks voxels that are not a source

inline Vec3f middleOf(const Index3& v) {
    return {float(v.x), float(v.y), float(v.z)};
}
/// Converts a vector from one frame to another.
inline Vec3f rotated(const Frame& from, const Frame& to, const Vec3f& v) {
    return to.t * dot(from.t, v) + to.n * dot(from.n, v) + to.b * dot(from.b, v);
}
/// Positions are never far below 0, and a library call for rounding would take a tenth of a sweep.
inline Index3 nearestVoxel(const Vec3f& p) {
    constexpr int kUp = 1024;
    const auto round = [](float v) { return int(v + (float(kUp) + 0.5f)) - kUp; };
    return {round(p.x), round(p.y), round(p.z)};
}

/// Where the feature of a voxel is sampled: from a place near it, moved along its normal to the nearest whole
/// depth. Depths of a flat pair's voxels have one fraction, a curved target's all; features at unlike
/// fractions would differ by more than a shallow texture does, and lines of equal depth would show in the
/// result.
inline Vec3f featurePlace(const Vec3f& place, const Frame& frame, float depth, bool aligned) {
    return aligned ? place + frame.n * (std::round(depth) - depth) : place;
}
inline float featureDepth(float depth, bool aligned) {
    return aligned ? std::round(depth) : depth;
}

/// One pair at all levels.
struct PairLevels {
    AnalogyPyramid plain, textured;
};

/// A voxel of a pair that may be copied.
struct AnalogyRow {
    std::int32_t pair = -1, voxel = -1;
};

/// A position of a pair: the row of the nearest voxel, and the offset from there. Sources of neighbouring
/// voxels that continue each other stay a whole: rounded to voxels, each would be off by its own half voxel,
/// and a texture a few voxels fine would blur away.
struct AnalogySource {
    std::int32_t row = -1;  ///< -1: none
    Vec3f offset{0, 0, 0};  ///< [voxels]
};

/// The pairs at one level: every voxel that may be copied, with its feature.
class AnalogyTraining {
public:
    /// @throw Error Unusable (a pair too small for the level)
    AnalogyTraining(const std::vector<AnalogyPair>& pairs, const std::vector<PairLevels>& levels, int level,
                    const FeatureShape& shape, const VolumeAnalogyOptions& options, const RunContext& ctx);

    const DepthClasses& depths() const { return mDepths; }
    const FeatureIndex& index() const { return *mIndex; }
    const ReducedFeatures& reduced() const { return mReduced; }
    const PrincipalAxes& axes() const { return mAxes; }
    std::size_t size() const { return mRows.size(); }
    const AnalogyRow& row(std::int32_t r) const { return mRows[std::size_t(r)]; }
    const Frame& frame(const AnalogyRow& r) const {
        return mVoxels[std::size_t(r.pair)].frame[std::size_t(r.voxel)];
    }
    Index3 voxel(const AnalogyRow& r) const {
        return mVoxels[std::size_t(r.pair)].table[std::size_t(r.voxel)];
    }
    float plainAt(const AnalogyRow& r) const { return plain(r).inside(voxel(r)); }
    /// The plain distance at a position of the row's pair.
    float plainThrough(const AnalogyRow& r, const Vec3f& at) const { return sampleTrilinear(plain(r), at); }
    const BrickField& textured(const AnalogyRow& r) const {
        return mLevels[std::size_t(r.pair)].textured.distance[std::size_t(mLevel)];
    }
    /// The row of a voxel, negative if it may not be copied.
    std::int32_t find(std::int32_t pair, const Index3& p) const {
        const std::int32_t voxel = mVoxels[std::size_t(pair)].table.find(p);
        return voxel < 0 ? -1 : mFirst[std::size_t(pair)] + voxel;
    }
    /// The source at a position of a pair; none if it may not be copied.
    AnalogySource sourceAt(std::int32_t pair, const Vec3f& at) const {
        const Index3 nearest = nearestVoxel(at);
        return {find(pair, nearest), at - middleOf(nearest)};
    }
    Vec3f placeOf(const AnalogySource& source) const {
        return middleOf(voxel(row(source.row))) + source.offset;
    }
    /// Where the feature of a row is sampled, beside its voxel by up to half a voxel along the surface: as on
    /// a target, whose voxels lie anywhere relative to the pair's. Features in the middle of all voxels are
    /// sharper than any between them, and on a target the plainest would be the most similar.
    AnalogySource featureSource(std::int32_t r) const;
    /// Half the distance that a patch can extend from the middle of a pair. [voxels]
    int patchReach(std::int32_t pair) const;

private:
    const BrickField& plain(const AnalogyRow& r) const {
        return mLevels[std::size_t(r.pair)].plain.distance[std::size_t(mLevel)];
    }
    IndexBox innerAt(const AnalogyPair& pair, int margin) const;
    void addDepths(const AnalogyPair& pair, std::size_t p);
    void addRows(const AnalogyPair& pair, std::size_t p, const VolumeAnalogyOptions& options,
                 const RunContext& ctx);
    void sample(std::size_t r, float* out) const;
    void learn(const VolumeAnalogyOptions& options, const RunContext& ctx);

    const std::vector<PairLevels>& mLevels;
    int mLevel;
    FeatureShape mShape;
    bool mAligned;
    DepthClasses mDepths;
    std::vector<AnalogyRow> mRows;
    std::vector<std::int32_t> mFirst;    // row of each pair's first voxel
    std::vector<AnalogyVoxels> mVoxels;  // of each pair
    std::vector<IndexBox> mInner;        // of each pair, what may be copied
    PrincipalAxes mAxes;
    ReducedFeatures mReduced;
    std::optional<FeatureIndex> mIndex;
};

/// Patches of the pairs over a target's surface: each begins at a random position with a random source
/// and extends from neighbour to neighbour, in both surfaces' frames, until it is as large as the pair
/// allows or meets another patch. Voxels above and below take the source of the surface's voxel
/// beneath them, at their own depth.
/// @par Repeats by ctx.seed
class PatchLayout {
public:
    /// All are borrowed. @param plain  distances of the target at the level
    PatchLayout(const AnalogyVoxels& voxels, const BrickField& plain, const AnalogyTraining& training,
                const RunContext& ctx);

    /// The initial source of voxel i; none if no patch covers it.
    AnalogySource sourceOf(std::size_t i) const;

private:
    struct Placed {
        std::int32_t pair = -1, row = -1;
        Vec3f at;
    };
    bool onSurface(std::size_t i) const;
    void grow(std::uint32_t first, std::int32_t seed);

    const AnalogyVoxels& mVoxels;
    const BrickField& mPlain;
    const AnalogyTraining& mTraining;
    std::vector<Placed> mPlaced;  // of voxels on the surface
};

}  // namespace vdbsynth
