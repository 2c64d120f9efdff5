// Closed parts with voids: each nesting's parts alone by OpenVDB, then combined. Nested surfaces do not meet,
// so the greater or lesser of two distances is the distance to both.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set_steps.h"
#include "libvdbsynth/vdb/grid_kinds.h"
#include "libvdbsynth/vdb/wall.h"

#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace vdbsynth {
namespace {

// How many surfaces of opposed parts lie around a part.
std::size_t depthOf(const MeshParts& parts, std::size_t part) {
    std::size_t depth = 0;
    for (int i = int(part); parts.parts[std::size_t(i)].around >= 0; i = parts.parts[std::size_t(i)].around)
        depth += parts.parts[std::size_t(i)].role == PartRole::United ? 0 : 1;
    return depth;
}

}  // namespace

std::vector<Mesh> nestedMeshes(const Mesh& mesh, const MeshParts& parts) {
    std::vector<std::size_t> depth(parts.parts.size());
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (parts.parts[i].role == PartRole::Open) return {};
        depth[i] = depthOf(parts, i);
        while (meshes.size() <= depth[i]) meshes.emplace_back();
    }
    std::vector<std::vector<std::uint32_t>> place(meshes.size(),
                                                  std::vector<std::uint32_t>(mesh.points.size(), ~0u));
    const std::vector<Triangle> triangles = triangulated(mesh);
    for (std::size_t f = 0; f < triangles.size(); ++f) {
        const std::size_t part = parts.partOf[f];
        // United parts add nothing but to what they cross.
        Mesh& to = meshes[depth[part]];
        Triangle t = triangles[f];
        for (std::uint32_t& corner : t) {
            std::uint32_t& at = place[depth[part]][corner];
            if (at == ~0u) {
                at = std::uint32_t(to.points.size());
                to.points.push_back(mesh.points[corner]);
            }
            corner = at;
        }
        if (parts.parts[part].signedVolume < 0) std::swap(t[1], t[2]);
        to.triangles.push_back(t);
    }
    return meshes;
}

void addNested(openvdb::FloatGrid& whole, openvdb::FloatGrid& next, bool isVoid, const std::string& name) {
    behindWall(ErrorCode::Unusable, name, [&] {
        if (isVoid)
            openvdb::tools::csgDifference(whole, next, /* prune= */ true);
        else
            openvdb::tools::csgUnion(whole, next, /* prune= */ true);
    });
}

}  // namespace vdbsynth
