#pragma once
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <cmath>

namespace vdbsynth {

/// Trilinear value of a field at a point [voxels]; outside the box that of the nearest voxels.
inline float sampleTrilinear(const BrickField& field, const Vec3f& p) {
    const float bx = std::floor(p.x), by = std::floor(p.y), bz = std::floor(p.z);
    const float fx = p.x - bx, fy = p.y - by, fz = p.z - bz;
    const Index3 base{int(bx), int(by), int(bz)}, far = base + Index3{1, 1, 1};
    float v[8];
    if (field.box().contains(base) && field.box().contains(far)) {
        for (int i = 0; i < 8; ++i) v[i] = field.inside(base + Index3{i >> 2, (i >> 1) & 1, i & 1});
    } else {
        for (int i = 0; i < 8; ++i) v[i] = field.at(base + Index3{i >> 2, (i >> 1) & 1, i & 1});
    }
    const auto mix = [](float a, float b, float t) { return a + (b - a) * t; };
    const float low = mix(mix(v[0], v[1], fz), mix(v[2], v[3], fz), fy),
                high = mix(mix(v[4], v[5], fz), mix(v[6], v[7], fz), fy);
    return mix(low, high, fx);
}

/// Gradient by central differences of the trilinear field, half a voxel to either side.
inline Vec3f sampleGradient(const BrickField& field, const Vec3f& p) {
    Vec3f gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f low = p, high = p;
        low[axis] -= 0.5f;
        high[axis] += 0.5f;
        gradient[axis] = sampleTrilinear(field, high) - sampleTrilinear(field, low);
    }
    return gradient;
}

}  // namespace vdbsynth
