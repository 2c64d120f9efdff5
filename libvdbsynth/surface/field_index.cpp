#include "libvdbsynth/surface/field_index.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/math/smallest_rotation.h"
#include "libvdbsynth/math/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

double principal(double angle) {
    return angle - 2 * kPi * std::round(angle / (2 * kPi));
}

}  // namespace

std::vector<int> fieldIndices(const Mesh& mesh, const std::vector<Vec3f>& normals,
                              const std::vector<Vec3f>& tangents) {
    if (normals.size() != mesh.points.size() || tangents.size() != mesh.points.size())
        throw Error(ErrorCode::ShapeMismatch, "points, normals and tangents differ in number");
    const auto turn = [&](std::uint32_t i, std::uint32_t j) {
        // Computed for the lower number first, so that both triangles at an edge see exactly opposite angles.
        const std::uint32_t a = std::min(i, j), b = std::max(i, j);
        const Vec3d n = cast<double>(normals[b]), t = cast<double>(tangents[b]);
        const Vec3d other = carried(cast<double>(tangents[a]), cast<double>(normals[a]), n);
        const double angle = arcTangent(dot(cross(other, t), n), dot(other, t));
        return i < j ? angle : -angle;
    };
    std::vector<int> indices;
    for (const Triangle& t : triangulated(mesh)) {
        const double sum = turn(t[0], t[1]) + turn(t[1], t[2]) + turn(t[2], t[0]);
        indices.push_back(int(std::lround((sum - principal(sum)) / (2 * kPi))));
    }
    return indices;
}

}  // namespace vdbsynth
