#pragma once
#include "libvdbsynth/math/smallest_rotation.h"
#include "libvdbsynth/math/vec2.h"
#include "libvdbsynth/points/surface_sites.h"

#include <cmath>
#include <vector>

namespace vdbsynth {

/// A site's tangent frame: u runs along `s`, v along `t`; t = n x s.
struct SiteFrame {
    Vec3f s, t;
};

inline SiteFrame siteFrame(const Vec3f& normal, const Vec3f& tangent) {
    return {tangent, cross(normal, tangent)};
}

/// The position of a place as the flattened neighbourhood of a frame sees it: in the direction of the
/// difference's projection, at its full length [zhang2004, appendix A, with the projection normalised]. A
/// difference along the normal gives (0, 0).
inline Vec2f flattened(const SiteFrame& frame, const Vec3f& difference) {
    const float x = dot(difference, frame.s), y = dot(difference, frame.t);
    const float across = std::sqrt(x * x + y * y), whole = length(difference);
    if (!(across > 1e-6f * whole)) return {};
    const float stretch = whole / across;
    return {x * stretch, y * stretch};
}

/// The rotation (cosine, sine) that takes directions of one frame to another's.
inline Vec2f frameRotation(const SiteFrame& from, const SiteFrame& to) {
    const float c = dot(from.s, to.s) + dot(from.t, to.t), s = dot(from.s, to.t) - dot(from.t, to.s);
    const float size = std::sqrt(c * c + s * s);
    return size > 1e-6f ? Vec2f{c / size, s / size} : Vec2f{1, 0};
}

inline Vec2f rotated(const Vec2f& v, const Vec2f& rotation) {
    return {rotation.x * v.x - rotation.y * v.y, rotation.y * v.x + rotation.x * v.y};
}

/// A unit tangent nearest to a direction; any one where that is along the normal.
Vec3f tangentNear(const Vec3f& normal, const Vec3f& direction);

}  // namespace vdbsynth
