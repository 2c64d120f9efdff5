#pragma once
#include "libvdbsynth/math/vec3.h"

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

/// Sums over points in space, relative to a place near them: of their coordinates and of the products of two.
struct PointSums {
    std::size_t count = 0;
    Vec3d first;
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    void add(const Vec3d& p) {
        ++count;
        first = first + p;
        xx += p.x * p.x;
        xy += p.x * p.y;
        xz += p.x * p.z;
        yy += p.y * p.y;
        yz += p.y * p.z;
        zz += p.z * p.z;
    }
};

/// All three axes of points in space, by ascending variance.
struct PointAxes {
    Vec3d mean;
    Vec3d axis[3];            ///< orthonormal; the largest component of each is positive
    double variance[3] = {};  ///< along them, at least 0

    /// Surface variation [pauly2002, Eq. 3]: the least variance over the sum of all, 0..1/3; 0 for coinciding
    /// points.
    double variation() const {
        const double sum = variance[0] + variance[1] + variance[2];
        return sum > 0 ? variance[0] / sum : 0;
    }
};

/// @param aboutMean  variances; else second moments about the sums' origin
/// @par Cost    O(1)   @par Repeats yes
PointAxes pointAxes(const PointSums& sums, bool aboutMean = true);

}  // namespace vdbsynth
