#pragma once
// What the files of mesh_distance share: a face's distance, and the voxels around one.
#include "libvdbsynth/distance/mesh_distance.h"
#include "libvdbsynth/math/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vdbsynth::nearest_face {

inline constexpr int kSide = BrickField::kSide;
inline constexpr int kPadded = kSide + 2;
inline constexpr float kFar = std::numeric_limits<float>::max();

struct Nearest {
    float distance = kFar;
    std::uint32_t face = kNoFace;
};
inline constexpr Nearest kNone;

/// What a triangle lies in: a disc, with which most triangles are refused at a fraction of their distance's
/// cost.
struct Disc {
    Vec3f centre;
    float radius = 0;
    Vec3f normal;  // of length 1, or 0 for a triangle without area: its disc is a ball
};

inline Disc discAround(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    Disc disc;
    disc.centre = (a + b + c) * (1.f / 3);
    disc.radius = std::max({length(a - disc.centre), length(b - disc.centre), length(c - disc.centre)});
    const Vec3f normal = cross(b - a, c - a);
    const float size = length(normal);
    // A sliver's normal is noise.
    if (size > 1e-2f * disc.radius * disc.radius) disc.normal = normal * (1 / size);
    return disc;
}

/// True if the disc is further away from p than `limit`; never true for one that is nearer.
inline bool isBeyond(const Disc& disc, const Vec3f& p, float limit) {
    const Vec3f offset = p - disc.centre;
    const float height = dot(offset, disc.normal), across = dot(offset, offset) - height * height;
    const float room = limit * limit - height * height;
    if (room < 0) return true;
    const float reach = std::sqrt(room) + disc.radius;
    return across > reach * reach;
}

/// A step to one of the 26 neighbours, the near ones first: they bring the answer, the others are then
/// skipped.
struct Step {
    int offset;  // in a padded brick
    float length;
};

inline const std::array<Step, 26>& neighbourSteps() {
    static const std::array<Step, 26> steps = [] {
        std::array<Step, 26> made{};
        std::size_t n = 0;
        for (int far = 1; far <= 3; ++far)
            for (const Index3& s : kAllNeighbours)
                if (s.x * s.x + s.y * s.y + s.z * s.z == far)
                    made[n++] = {(s.x * kPadded + s.y) * kPadded + s.z, std::sqrt(float(far)) + 1e-5f};
        return made;
    }();
    return steps;
}

/// A brick and one layer around it; kFar where nothing is to be tried.
struct Padded {
    float distance[kPadded * kPadded * kPadded];
    std::uint32_t face[kPadded * kPadded * kPadded] = {};
    bool row[kPadded * kPadded];  // rows along z with something to be tried
};

/// For each voxel of a row the neighbours, by bit, whose faces may be nearer than its own: a face cannot be
/// nearer here than its distance there less the step.
/// @param centre  of the row's first voxel in `around`   @param row, steps  kSide of them
void worthTrying(const Padded& around, int centre, const Nearest* row, float halfWidth, std::uint32_t* steps);

inline bool better(const Nearest& a, const Nearest& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.face < b.face;
}

/// Squared distance to the triangle a, b, c [ericson2005, section 5.1.5] of a point that lies at a + ap; all
/// that is computed is of a voxel's size, so that floats do.
inline float squaredDistance(const Vec3f& ap, const Vec3f& ab, const Vec3f& ac) {
    const auto squaredAt = [&](float v, float w) {
        const Vec3f offset = ap - ab * v - ac * w;
        return dot(offset, offset);
    };
    const float d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squaredAt(0, 0);
    const float bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const float d3 = d1 - bb, d4 = d2 - bc;
    if (d3 >= 0 && d4 <= d3) return squaredAt(1, 0);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squaredAt(d1 > d3 ? d1 / (d1 - d3) : 0.f, 0);
    const float d5 = d1 - bc, d6 = d2 - cc;
    if (d6 >= 0 && d5 <= d6) return squaredAt(0, 1);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squaredAt(0, d2 > d6 ? d2 / (d2 - d6) : 0.f);
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6) {
        const float sum = (d4 - d3) + (d5 - d6);
        const float w = sum > 0 ? (d4 - d3) / sum : 0.f;
        return squaredAt(1 - w, w);
    }
    const float area = va + vb + vc;
    if (!(area > 0)) return std::min({squaredAt(0, 0), squaredAt(1, 0), squaredAt(0, 1)});
    // A sliver's rounding may lead outside it.
    const float v = std::clamp(vb / area, 0.f, 1.f);
    return squaredAt(v, std::clamp(vc / area, 0.f, 1 - v));
}

/// The faces that were tried on one voxel.
class FacesTried {
public:
    /// False if the face was there already.
    bool add(std::uint32_t face) {
        const std::uint64_t bit = std::uint64_t(1) << (face & 63);
        if (mBits & bit)
            for (int i = 0; i < mCount; ++i)
                if (mFaces[i] == face) return false;
        mBits |= bit;
        mFaces[mCount++] = face;
        return true;
    }

private:
    std::uint64_t mBits = 0;
    int mCount = 0;
    std::uint32_t mFaces[26];
};

}  // namespace vdbsynth::nearest_face
