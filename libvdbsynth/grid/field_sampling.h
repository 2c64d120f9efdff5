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

/// What a cubic polynomial (Catmull-Rom) says of a field at a point [voxels]. Trilinear values cut crests: a
/// wave of length w loses (pi / w)^2 / 2 of its amplitude between samples.
inline float sampleCubic(const BrickField& field, const Vec3f& p) {
    Index3 first;
    float weight[3][4];
    for (int axis = 0; axis < 3; ++axis) {
        const float low = std::floor(p[axis]), t = p[axis] - low;
        first[axis] = int(low) - 1;
        weight[axis][0] = ((2 - t) * t - 1) * t / 2;
        weight[axis][1] = ((3 * t - 5) * t * t + 2) / 2;
        weight[axis][2] = ((4 - 3 * t) * t + 1) * t / 2;
        weight[axis][3] = (t - 1) * t * t / 2;
    }
    float values[64], sum = 0;
    field.readBox(first, {4, 4, 4}, values);
    const float* v = values;
    for (const float x : weight[0])
        for (const float y : weight[1]) {
            sum += x * y *
                   (weight[2][0] * v[0] + weight[2][1] * v[1] + weight[2][2] * v[2] + weight[2][3] * v[3]);
            v += 4;
        }
    return sum;
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
