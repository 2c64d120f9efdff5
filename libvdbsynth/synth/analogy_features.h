#pragma once
#include "libvdbsynth/math/pca.h"
#include "libvdbsynth/synth/analogy_level.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// Sizes of a feature [bhat2004, 4.2, 4.3]: the causal half cube of the textured model (t = -half..-1, b and
/// n both ways), then the rest: the full cube of the plain one and, unless the level is the coarsest, the
/// small cubes of both at the next coarser level.
struct FeatureShape {
    int half = 2, coarseHalf = 1;
    bool coarse = true;

    std::size_t causal() const { return std::size_t(half * (2 * half + 1) * (2 * half + 1)); }
    std::size_t rest() const {
        const int full = 2 * half + 1, small = 2 * coarseHalf + 1;
        return std::size_t(full * full * full + (coarse ? 2 * small * small * small : 0));
    }
    std::size_t size() const { return causal() + rest(); }
};

/// Densities a feature is read from; the coarser ones null at the coarsest level.
struct FeatureFields {
    const BrickField* plain = nullptr;
    const BrickField* coarsePlain = nullptr;
    const BrickField* coarseTextured = nullptr;
};

/// Samples one voxel apart along t, n and b, between voxels trilinearly [bhat2004, 5.3].
void sampleCausal(const FeatureShape& shape, const BrickField& textured, const Vec3f& at, const Frame& frame,
                  float* out);
void sampleRest(const FeatureShape& shape, const FeatureFields& fields, const Vec3f& at, const Frame& frame,
                float* out);

/// Features as few numbers: their coordinates along principal axes, of which the causal part and the rest are
/// taken one after the other, since the rest of a voxel never changes while a level is made.
class ReducedFeatures {
public:
    ReducedFeatures() = default;
    ReducedFeatures(const FeatureShape& shape, const PrincipalAxes& axes);

    std::size_t count() const { return mCount; }
    /// out = what the causal samples add to `rest`   @param out [count]
    void addCausal(const float* causal, const float* rest, float* out) const;
    /// out = coordinates of the rest alone
    void ofRest(const float* rest, float* out) const;

private:
    void add(std::size_t begin, std::size_t end, const float* samples, float* out) const;
    std::size_t mCausal = 0, mLength = 0, mCount = 0;
    std::vector<float> mAxes, mMean;  // [length x count]
};

}  // namespace vdbsynth
