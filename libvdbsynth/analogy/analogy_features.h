#pragma once
#include "libvdbsynth/analogy/analogy_level.h"
#include "libvdbsynth/math/pca.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// Sizes of a feature. It begins with samples of the field being synthesized, the textured model, around the
/// voxel: the cube without its middle, or the causal half (t = -half..-1, b and n both ways) [bhat2004, 4.2].
/// Then follows the rest, which does not change during a level: the cube of the plain model and, except at
/// the coarsest level, the small cubes of both at the next coarser level [4.3].
struct FeatureShape {
    int half = 2, coarseHalf = 1;
    bool causal = false;
    bool coarse = true;

    std::size_t made() const {
        const int side = 2 * half + 1;
        return std::size_t(causal ? half * side * side : side * side * side - 1);
    }
    std::size_t rest() const {
        const int full = 2 * half + 1, small = 2 * coarseHalf + 1;
        return std::size_t(full * full * full + (coarse ? 2 * small * small * small : 0));
    }
    std::size_t size() const { return made() + rest(); }
};

/// Densities that a feature is sampled from; the coarser ones null at the coarsest level.
struct FeatureFields {
    const BrickField* plain = nullptr;
    const BrickField* coarsePlain = nullptr;
    const BrickField* coarseTextured = nullptr;
};

/// Samples one voxel apart along t, n and b, trilinear between voxels [bhat2004, 5.3]. With a
/// curvature the cube follows the surface, which the paper left open: column (t, b) is at p + t T + b
/// B - II(t, b) / 2 N and runs along N + II'(t, b), the normal there to first order. A curvature of 0
/// gives the paper's straight cube.
void sampleMade(const FeatureShape& shape, const BrickField& textured, const Vec3f& at, const Frame& frame,
                const Curvature& curvature, float* out);
void sampleRest(const FeatureShape& shape, const FeatureFields& fields, const Vec3f& at, const Frame& frame,
                const Curvature& curvature, float* out);

/// Features reduced to few numbers: their coordinates along principal axes, as the sum of the contributions
/// of the synthesized samples and of the rest, and the voxel's depth. A voxel away from a surface all
/// densities are equal, so without the depth sources from there would not keep their depth.
class ReducedFeatures {
public:
    ReducedFeatures() = default;
    ReducedFeatures(const FeatureShape& shape, const PrincipalAxes& axes);

    std::size_t count() const { return mCount + 1; }
    /// out = contribution of the synthesized samples to `rest`   @param out [count]
    void addMade(const float* made, const float* rest, float* out) const;
    /// out = coordinates of the rest alone
    /// @param depth  distance from the plain model's surface [voxels]
    void ofRest(const float* rest, float depth, float* out) const;

private:
    void add(std::size_t begin, std::size_t end, const float* samples, float* out) const;
    std::size_t mMade = 0, mLength = 0, mCount = 0;
    std::vector<float> mAxes, mMean;  // [length x count]
};

}  // namespace vdbsynth
