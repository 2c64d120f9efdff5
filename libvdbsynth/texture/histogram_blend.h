#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/coordinates/sample_image.h"
#include "libvdbsynth/math/pca.h"

#include <cstddef>
#include <vector>

namespace vdbsynth {

/// A place of the sample and its share in a blend.
struct BlendPart {
    Vec2f at;          ///< [texels]
    float weight = 0;  ///< above 0; only ratios matter
};

inline constexpr std::size_t kMostBlendParts = 4;

/// Mixes places of a sample so that the mix has the sample's histogram: channels are decorrelated by the
/// eigenvectors of their covariance, each component gets the normal distribution by rank, Gaussian values
/// are mixed as  sum(w_i g_i) / sqrt(sum(w_i^2)),  which keeps their variance, and an inverse table takes
/// them back [heitz2018, 3 and 4; deliot2019]. A plain weighted mean loses about 30 % of the contrast.
/// Equal values get the mean of their ranks.
class HistogramBlend {
public:
    /// @throw Error EmptyInput, ShapeMismatch (as requireSample), Cancelled
    /// @par Cost O(texels log texels) for each channel   @par Repeats yes
    explicit HistogramBlend(const SampleImage& sample, const RunContext& ctx = {});

    /// @param count  1..kMostBlendParts   @param out  [channels]
    void mix(const BlendPart* parts, std::size_t count, float* out) const;

private:
    PrincipalAxes mAxes;
    SampleImage mGaussian;        // components in place of channels
    std::vector<float> mInverse;  // [components x kTable]
};

/// The quantile function of the normal distribution, relative error below 2e-9. @param share  0 < share < 1
double normalQuantile(double share);

/// How much of the sample's structure mixing destroys, measured on the flat sample: windows of 9 x 9 places,
/// a texel and 3 texels apart, are read from an even mix of two random places, and from the first of them;
/// the number is the mean distance of a mixed window to the nearest window of the sample that overlaps
/// neither place, over that of the unmixed one, the larger of the two sizes. 1: mixed windows look like the
/// sample's; ghosts of bricks or petals have nothing like them there. Measured: noise 1.00, sand 0.99,
/// bark 1.01, metal 1.01; gravel 1.04, weave 1.06, stones in mortar 1.09, flowers 1.12, a brick wall 2.1,
/// knurling 8.9.
/// @return 1 for a sample too small to tell, at least 0
/// @throw Error EmptyInput, ShapeMismatch, Unusable (as requireSample), Cancelled
/// @par Cost   about 0.2 s   @par Repeats same bits for any number of threads
double blendLoss(const SampleImage& sample, const RunContext& ctx = {});

/// A sample with at most this blendLoss is mixed by HistogramBlend unless told otherwise.
inline constexpr double kBlendSuits = 1.02;

}  // namespace vdbsynth
