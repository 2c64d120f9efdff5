#pragma once
#include "libvdbsynth/math/trigonometry.h"
#include "tests/support/makers.h"

#include <functional>

// Surfaces with relief as fields clamped to +-3, boxes beginning at 0.
namespace vdbsynth::test {

inline BrickField ballField(double radius, int margin) {
    const int side = int(2 * radius) + 2 * margin + 1;
    const double m = (side - 1) / 2.0;
    return fieldFrom({side, side, side}, [=](const Index3& p) {
        const Vec3d d = Vec3d{p.x - m, p.y - m, p.z - m};
        return float(std::clamp(length(d) - radius, -3.0, 3.0));
    });
}

/// A ground of height(x, y) over the middle of the box, solid below; distances to first order.
inline BrickField groundField(const Index3& size, const std::function<double(double, double)>& height) {
    return fieldFrom(size, [=](const Index3& p) {
        const double x = p.x, y = p.y, e = 0.01, h = height(x, y);
        const double dx = (height(x + e, y) - height(x - e, y)) / (2 * e);
        const double dy = (height(x, y + e) - height(x, y - e)) / (2 * e);
        const double d = (p.z - size.z / 2 - h) / std::sqrt(1 + dx * dx + dy * dy);
        return float(std::clamp(d, -3.0, 3.0));
    });
}

inline BrickField waveField(const Index3& size, double wave, double amplitude) {
    return groundField(size, [=](double x, double) { return amplitude * sine(2 * kPi * x / wave); });
}

}  // namespace vdbsynth::test
