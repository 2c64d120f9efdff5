#pragma once
#include "libvdbsynth/base/run_context.h"
#include "libvdbsynth/geometry/mesh.h"
#include "libvdbsynth/math/vec3.h"
#include "libvdbsynth/solid/mesh_parts.h"

#include <vector>

namespace vdbsynth {

// Steps of meshParts; for the .cpp files of mesh_parts only.

struct FaceCorners {
    Vec3d a, b, c;
    Vec3d middle() const { return (a + b + c) * (1.0 / 3); }
    Vec3d areaVector() const { return cross(b - a, c - a) * 0.5; }
};

inline FaceCorners cornersOf(const Mesh& mesh, const Triangle& t) {
    return {cast<double>(mesh.points[t[0]]), cast<double>(mesh.points[t[1]]),
            cast<double>(mesh.points[t[2]])};
}

/// Sets which part lies in which, and from that the roles of those that are not open.
/// @param parts  their sums; closed ones marked Solid
void findNesting(const Mesh& mesh, const std::vector<Triangle>& triangles, MeshParts& parts,
                 const RunContext& ctx);

}  // namespace vdbsynth
