#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"

#include <cstdint>
#include <vector>

namespace vdbsynth {

/// Generalised winding number of a mesh [jacobson2013, Eq. 6]: the solid angle of all faces seen from a
/// point, over 4 pi. 1 inside and 0 outside a closed mesh whose faces run counter-clockwise from outside; for
/// an open mesh it changes smoothly across the openings, and the level 1/2 closes the solid. Distant faces
/// are summed by the first term of their clusters' expansion [barill2018, Eq. 12]: a cluster is distant
/// beyond three times its radius, where the error is about 1e-2.
class WindingNumber {
public:
    /// @param mesh  indices in range; faces of zero area have no effect
    /// @par Cost    O(faces log faces), memory about 120 bytes per face
    /// @par Repeats yes
    explicit WindingNumber(const Mesh& mesh, const RunContext& ctx = {});

    /// For oriented points that each represent an area [barill2018, Eq. 5]: about 1 inside and 0 outside the
    /// sampled surface, some spacings away from it.
    /// @param normals  unit, outward; as many as points, as are areas [world^2]
    WindingNumber(const std::vector<Vec3f>& points, const std::vector<Vec3f>& normals,
                  const std::vector<float>& areas, const RunContext& ctx = {});

    /// @par Cost    O(log faces); may be called from many threads
    double at(const Vec3d& point) const;

private:
    struct Node {
        Vec3f centre;             // of its faces, weighted by area
        float radius = 0;         // of a ball around it that contains the faces
        Vec3f dipole;             // sum of area times normal
        std::uint32_t first = 0;  // of its faces
        std::uint32_t count = 0;
        std::uint32_t right = 0;  // second child; the first one follows the node; 0: a leaf
    };
    // Corners of a face, or position and dipole of a point.
    struct Face {
        Vec3f a, b, c;
    };
    struct Moments {
        Vec3d middle, dipole;
    };
    Moments momentsOf(const Face& face) const;

    std::uint32_t build(std::uint32_t first, std::uint32_t count);

    bool mPoints = false;
    std::vector<Face> mFaces;
    std::vector<Node> mNodes;
};

/// Share of a mesh's area with a distinct inside and outside: faces whose winding numbers on both sides have
/// a mean of at least 0.2 (1/2 on a closed mesh, 0 on a flat sheet). From at most 4096 faces.
/// @par Repeats yes
double solidShare(const Mesh& mesh, const WindingNumber& winding);

}  // namespace vdbsynth
