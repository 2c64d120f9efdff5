#pragma once
#include "libvdbsynth/analogy/analogy_level.h"
#include "libvdbsynth/math/pca.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// Sizes of a feature: first samples of what is being made, the textured model, around the voxel: all of the
/// cube but its middle, or the causal half (t = -half..-1, b and n both ways) [bhat2004, 4.2]; then the rest,
/// which does not change while a level is made: the cube of the plain model and, unless the level is the
/// coarsest, the small cubes of both at the next coarser level [4.3].
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

/// Densities a feature is read from; the coarser ones null at the coarsest level.
struct FeatureFields {
    const BrickField* plain = nullptr;
    const BrickField* coarsePlain = nullptr;
    const BrickField* coarseTextured = nullptr;
};

/// Samples one voxel apart along t, n and b, between voxels trilinearly [bhat2004, 5.3]. With a bend the cube
/// follows the surface, which the paper left open: column (t, b) stands on p + t T + b B - II(t, b) / 2 N and
/// runs along N + II'(t, b), the normal there to first order. A bend of 0 is the paper's straight cube.
void sampleMade(const FeatureShape& shape, const BrickField& textured, const Vec3f& at, const Frame& frame,
                const Bend& bend, float* out);
void sampleRest(const FeatureShape& shape, const FeatureFields& fields, const Vec3f& at, const Frame& frame,
                const Bend& bend, float* out);

/// Features as few numbers: their coordinates along principal axes, to which the samples of what is being
/// made and the rest are added one after the other, and the voxel's depth: densities are all alike a voxel
/// away from a surface, and without it nothing would keep what is copied from there at its depth.
class ReducedFeatures {
public:
    ReducedFeatures() = default;
    ReducedFeatures(const FeatureShape& shape, const PrincipalAxes& axes);

    std::size_t count() const { return mCount + 1; }
    /// out = what the samples of what is being made add to `rest`   @param out [count]
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
