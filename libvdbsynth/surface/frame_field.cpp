#include "libvdbsynth/surface/frame_field.h"

#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbsynth {
namespace {

constexpr float kReach = 1.9f;    // [voxels] of shell voxels that are averaged
constexpr float kSameSide = 6.f;  // [voxels] of sweep distance; more is beyond a cut

}  // namespace

Frame frameFrom(const Vec3f& normal, const Vec3f& direction) {
    Frame frame;
    frame.n = normalized(normal);
    Vec3f t = direction - frame.n * dot(direction, frame.n);
    if (length(t) < 1e-4f * length(direction) || length(t) == 0) {
        const Vec3f other = std::abs(frame.n.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
        t = other - frame.n * dot(other, frame.n);
    }
    frame.t = normalized(t);
    frame.b = cross(frame.t, frame.n);
    return frame;
}

Vec3f rotationBetween(const Frame& from, const Frame& to) {
    double m[3][3];
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            m[row][column] = double(to.t[row]) * double(from.t[column]) +
                             double(to.n[row]) * double(from.n[column]) +
                             double(to.b[row]) * double(from.b[column]);
    const Vec3d twist{m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
    const double sine2 = length(twist), cosine2 = m[0][0] + m[1][1] + m[2][2] - 1;
    if (sine2 > 1e-4) return cast<float>(twist * (arcTangent(sine2, cosine2) / sine2));
    if (cosine2 > 0) return {0, 0, 0};
    // A half rotation: m = 2 a a^T - 1, of whose columns the one with the largest
    // diagonal is the most accurate.
    const int clear = m[0][0] >= m[1][1] && m[0][0] >= m[2][2] ? 0 : m[1][1] >= m[2][2] ? 1 : 2;
    Vec3d axis{m[0][clear], m[1][clear], m[2][clear]};
    axis[clear] += 1;
    return cast<float>(normalized(axis) * kPi);
}

FrameField::FrameField(std::shared_ptr<const BrickField> distance, SurfaceShell shell,
                       DirectionField directions, SweepDistance sweep)
    : mDistance(std::move(distance)),
      mShell(std::move(shell)),
      mDirections(std::move(directions)),
      mSweep(std::move(sweep)) {}

bool FrameField::at(const Vec3f& point, Frame& frame, float& sweep) const {
    const Vec3f foot = projectToSurface(*mDistance, point);
    const Index3 base{int(std::floor(foot.x)), int(std::floor(foot.y)), int(std::floor(foot.z))};
    struct Near {
        std::size_t voxel;
        float weight;
    };
    Near near[64];
    int count = 0;
    float nearest = 0;
    std::size_t first = 0;
    forEachVoxel(IndexBox::cube(base - Index3{1, 1, 1}, 4), [&](const Index3& p) {
        const std::int32_t i = mShell.table.find(p);
        if (i < 0) return;
        const Vec3f offset = mShell.point[std::size_t(i)] - foot;
        const float weight = kReach - length(offset);
        if (weight <= 0) return;
        near[count++] = {std::size_t(i), weight * weight};
        if (weight > nearest) {
            nearest = weight;
            first = std::size_t(i);
        }
    });
    if (count == 0) return false;
    Vec3f direction, normal;
    float sum = 0, weights = 0;
    for (int k = 0; k < count; ++k) {
        const auto& [i, weight] = near[k];
        if (dot(mShell.normal[i], mShell.normal[first]) <= 0) continue;
        direction = direction + mDirections.tangent[i] * weight;
        normal = normal + mShell.normal[i] * weight;
        if (std::abs(mSweep.distance[i] - mSweep.distance[first]) > kSameSide) continue;
        sum += weight * (mSweep.distance[i] + dot(mDirections.tangent[i], foot - mShell.point[i]));
        weights += weight;
    }
    const Vec3f gradient = sampleGradient(*mDistance, point);
    frame = frameFrom(length(gradient) > 0.5f ? gradient : normal, direction);
    sweep = sum / weights;
    return true;
}

}  // namespace vdbsynth
