#pragma once
#include "tests/support/makers.h"

#include <memory>

// Exact distance fields of simple shapes, boxes beginning at 0, clamped to +-12.
namespace vdbsynth::test {

inline std::shared_ptr<const BrickField> shapeField(const Index3& size,
                                                    const std::function<double(const Vec3d&)>& distance) {
    return std::make_shared<const BrickField>(fieldFrom(size, [&](const Index3& p) {
        return float(std::clamp(distance({double(p.x), double(p.y), double(p.z)}), -12.0, 12.0));
    }));
}
inline std::shared_ptr<const BrickField> planeField(int side, double height) {
    return shapeField({side, side, side}, [=](const Vec3d& p) { return p.z - height; });
}
inline std::shared_ptr<const BrickField> sphereField(int side, double radius) {
    const double m = (side - 1) / 2.0;
    return shapeField({side, side, side}, [=](const Vec3d& p) {
        return length(p - Vec3d{m, m, m}) - radius;
    });
}
/// Along z.
inline std::shared_ptr<const BrickField> cylinderField(int side, double radius) {
    const double m = (side - 1) / 2.0;
    return shapeField({side, side, side}, [=](const Vec3d& p) {
        return std::sqrt((p.x - m) * (p.x - m) + (p.y - m) * (p.y - m)) - radius;
    });
}

}  // namespace vdbsynth::test
