#include "libvdbsynth/geometry/mesh_check.h"

#include "libvdbsynth/base/error.h"

#include <cmath>

namespace vdbsynth {

void requireMesh(const Mesh& mesh, const std::string& what) {
    if (mesh.faceCount() == 0) throw Error(ErrorCode::EmptyInput, what + ": the mesh has no faces");
    const auto require = [&](const auto& faces) {
        for (std::size_t f = 0; f < faces.size(); ++f)
            for (std::uint32_t corner : faces[f])
                if (corner >= mesh.points.size())
                    throw Error(ErrorCode::BadData, what + ": face " + std::to_string(f) + " uses point " +
                                                        std::to_string(corner) + " of " +
                                                        std::to_string(mesh.points.size()));
    };
    require(mesh.triangles);
    require(mesh.quads);
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        if (!std::isfinite(mesh.points[i].x) || !std::isfinite(mesh.points[i].y) ||
            !std::isfinite(mesh.points[i].z))
            throw Error(ErrorCode::BadData, what + ": point " + std::to_string(i) + " is not finite");
    for (const Attribute& attribute : mesh.attributes)
        if (attribute.values.size() != mesh.points.size() * attribute.width)
            throw Error(ErrorCode::BadData,
                        what + ": attribute \"" + attribute.name + "\" does not have one row per point");
}

}  // namespace vdbsynth
