#pragma once
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/vec3.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbsynth {

/// A place as it is in the rest pose.
struct RestPlace {
    Vec3d place;  ///< [world]
    std::array<Vec3d, 3>
        turn;  ///< where the world's axes at rest point in the pose: at right angles, length 1
};

/// A surface in two poses. Places beside the posed surface belong to places beside the one at rest:
///     x_rest = f_rest + T^t (x - f),
/// f the posed surface's nearest point, f_rest that of the same face and barycentric coordinates, T the
/// rotation there: of every vertex the one nearest to the sum of its faces' rotations times their areas
/// [polar decomposition], interpolated over faces. Heights over the surface stay, along it textures stretch
/// as the faces do. Where both poses are the same every place is its own.
class RestMap {
public:
    /// @param rest, posed  [world] of the same faces, in any order, and the same vertices in the same order;
    /// polygons may be split into triangles otherwise in one pose, as readers split those that are concave
    /// there
    /// @throw Error ShapeMismatch (other faces or another number of vertices), EmptyInput (no faces)
    /// @par Cost    O(faces), O(faces * log faces) where polygons are split otherwise   @par Repeats yes
    RestMap(const Mesh& rest, const Mesh& posed);

    /// The posed surface: triangles only, in the order that `face` of `at` counts in.
    const Mesh& posed() const { return mPosed; }
    /// @param face  of posed() that is nearest to the place
    RestPlace at(const Vec3d& place, std::uint32_t face) const;

private:
    Mesh mRest, mPosed;
    std::vector<std::array<Vec3d, 3>> mTurn;  // [vertices]
};

}  // namespace vdbsynth
