#pragma once
#include <cstddef>
#include <vector>

namespace vdbsynth {

/// value = constant + weights . vector
struct AffineMap {
    std::vector<float> weights;
    float constant = 0;

    float operator()(const float* vector) const {
        float sum = constant;
        for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * vector[k];
        return sum;
    }
};

/// The affine map with the least sum of squared errors, by the normal equations; sums in
/// double and in a fixed order.
/// @param vectors  [rows x length]    @param values  [rows]
/// @param ridge    added to the covariance's diagonal, as a share of its mean; keeps undetermined weights
/// small. Above 0
/// @par Cost    O(rows * length^2 + length^3)    @par Repeats yes
AffineMap fitAffine(const std::vector<float>& vectors, std::size_t length, const std::vector<float>& values,
                    double ridge = 1e-9);

}  // namespace vdbsynth
