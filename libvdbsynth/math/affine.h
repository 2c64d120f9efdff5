#pragma once
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstddef>

namespace vdbsynth {

/// An affine map as a 4 x 4 matrix, column by column.
using Affine = std::array<double, 16>;

inline constexpr Affine kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The composition: b, then a.
inline Affine multiplied(const Affine& a, const Affine& b) {
    Affine result{};
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t k = 0; k < 4; ++k) result[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
    return result;
}

/// The rotation by a unit quaternion.
inline Affine rotation(double x, double y, double z, double w) {
    Affine m = kIdentity;
    m[0] = 1 - 2 * (y * y + z * z);
    m[1] = 2 * (x * y + z * w);
    m[2] = 2 * (x * z - y * w);
    m[4] = 2 * (x * y - z * w);
    m[5] = 1 - 2 * (x * x + z * z);
    m[6] = 2 * (y * z + x * w);
    m[8] = 2 * (x * z + y * w);
    m[9] = 2 * (y * z - x * w);
    m[10] = 1 - 2 * (x * x + y * y);
    return m;
}

/// The factor by which volumes grow; negative for reflections.
inline double determinant(const Affine& m) {
    return m[0] * (m[5] * m[10] - m[9] * m[6]) - m[4] * (m[1] * m[10] - m[9] * m[2]) +
           m[8] * (m[1] * m[6] - m[5] * m[2]);
}

inline Vec3d transformed(const Affine& m, const Vec3d& p) {
    Vec3d result;
    for (int r = 0; r < 3; ++r)
        result[r] = m[std::size_t(r)] * p.x + m[std::size_t(4 + r)] * p.y + m[std::size_t(8 + r)] * p.z +
                    m[std::size_t(12 + r)];
    return result;
}

}  // namespace vdbsynth
