#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/grid/brick_field.h"
#include "libvdbsynth/math/vec3.h"

#include <functional>
#include <vector>

namespace vdbsynth {

/// A ball, capsule or torus: signed distances are exact. [voxels]
struct Primitive {
    enum class Kind { Capsule, Torus } kind = Kind::Capsule;
    Vec3d a, b;         ///< capsule: ends (equal for a ball); torus: centre and unit axis
    double radius = 1;  ///< of the ball, the capsule or the torus's tube
    double ring = 0;    ///< torus: distance from centre to the middle of the tube

    double distance(const Vec3d& p) const;
    /// A bounding ball of the primitive.
    void bound(Vec3d& centre, double& boundRadius) const;
};

Primitive ball(const Vec3d& centre, double radius);
Primitive capsule(const Vec3d& a, const Vec3d& b, double radius);
Primitive torus(const Vec3d& centre, const Vec3d& axis, double ring, double tube);
/// The same shape in voxels of 1/`by` the side.
Primitive scaled(Primitive shape, double by);

/// The distance to the union of primitives at any place of a box and `reach` [voxels] around it; farther ones
/// than `reach` count as that. Exact outside the union; inside overlaps it is the deepest primitive's.
/// @par Cost of a call O(primitives near)
std::function<double(const Vec3d&)> unionDistance(const std::vector<Primitive>& primitives,
                                                  const IndexBox& box, double reach);

/// Distance to the union of primitives over a box, clamped to +-limit. Exact outside the union; inside
/// overlaps it is the deepest primitive's. Cost O(bricks * primitives near each).
BrickField unionField(const std::vector<Primitive>& primitives, const IndexBox& box, float limit,
                      const RunContext& ctx);

}  // namespace vdbsynth
