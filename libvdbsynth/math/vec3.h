#pragma once
#include <cmath>

namespace vdbsynth {

/// A point or direction in three dimensions; plain data for all rooms.
template <typename T>
struct Vec3 {
    T x = 0, y = 0, z = 0;

    T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <typename T>
Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
Vec3<T> operator-(const Vec3<T>& a) {
    return {-a.x, -a.y, -a.z};
}
template <typename T>
Vec3<T> operator*(const Vec3<T>& a, T s) {
    return {a.x * s, a.y * s, a.z * s};
}
template <typename T>
Vec3<T> operator*(T s, const Vec3<T>& a) {
    return a * s;
}
template <typename T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T length(const Vec3<T>& a) {
    return std::sqrt(dot(a, a));
}
/// Zero stays zero.
template <typename T>
Vec3<T> normalized(const Vec3<T>& a) {
    const T l = length(a);
    return l > T(0) ? a * (T(1) / l) : a;
}
template <typename To, typename From>
Vec3<To> cast(const Vec3<From>& a) {
    return {To(a.x), To(a.y), To(a.z)};
}

}  // namespace vdbsynth
