#pragma once
#include "libvdbsynth/math/vec3.h"

#include <algorithm>

namespace vdbsynth {

/// A vector after the smallest rotation that takes one unit vector to another [moller1999]: how a tangent is
/// carried from one normal to the next. Next to opposite vectors, of which the rotation is not determined,
/// the result is finite but means nothing.
template <typename T>
Vec3<T> carried(const Vec3<T>& vector, const Vec3<T>& from, const Vec3<T>& to) {
    const Vec3<T> axis = cross(from, to);
    const T cosine = std::max(dot(from, to), T(-0.999));
    return vector * cosine + cross(axis, vector) + axis * (dot(axis, vector) / (1 + cosine));
}

}  // namespace vdbsynth
