#pragma once
#include <cmath>

namespace vdbsynth {

/// A point or direction in the plane of a sample or a chart.
struct Vec2f {
    float x = 0, y = 0;
};

inline Vec2f operator+(const Vec2f& a, const Vec2f& b) {
    return {a.x + b.x, a.y + b.y};
}
inline Vec2f operator-(const Vec2f& a, const Vec2f& b) {
    return {a.x - b.x, a.y - b.y};
}
inline Vec2f operator*(const Vec2f& a, float s) {
    return {a.x * s, a.y * s};
}
inline float dot(const Vec2f& a, const Vec2f& b) {
    return a.x * b.x + a.y * b.y;
}
inline float length(const Vec2f& a) {
    return std::sqrt(dot(a, a));
}

}  // namespace vdbsynth
