#pragma once
#include <cstddef>
#include <vector>

namespace vdbsynth {

/// The directions along which vectors vary most.
struct PrincipalAxes {
    std::size_t length = 0;   ///< of the vectors
    std::size_t count = 0;    ///< of the axes
    std::vector<float> mean;  ///< [length]
    std::vector<float> axes;  ///< [count x length], orthonormal, by descending variance
    double explained = 0;     ///< share of the variance that they explain, 0..1

    /// Coordinates of a vector along the axes: out[i] = axes[i] . (vector - mean).
    void project(const float* vector, float* out) const;
};

/// Principal component analysis by the covariance's eigenvectors, sums in double and in a fixed order; the
/// largest component of each axis is positive.
/// @param vectors  [rows x length]
/// @param most     largest number of axes, at least 1
/// @param share    stops at the axes that explain this share of the variance
/// @par Cost    O(rows * length^2 + length^3)    @par Repeats yes
PrincipalAxes principalAxes(const std::vector<float>& vectors, std::size_t length, std::size_t most,
                            double share);

}  // namespace vdbsynth
