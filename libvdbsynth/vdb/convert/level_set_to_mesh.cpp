#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/geometry/local_points.h"
#include "libvdbsynth/vdb/convert/zero_level.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vdbsynth {
namespace {

constexpr float kGap = 0.02f;  // [voxels] between sheets that touched

void toWorld(const openvdb::FloatGrid& grid, Mesh& mesh) {
    std::vector<Vec3d> world;
    world.reserve(mesh.points.size());
    for (const Vec3f& p : mesh.points) world.push_back(fromVec(grid.indexToWorld(toVec(cast<double>(p)))));
    LocalPoints local = localPoints(world);
    mesh.points = std::move(local.points);
    mesh.origin = local.origin;
    // A transform with a reflection reverses the faces.
    if (grid.transform().baseMap()->getAffineMap()->getMat4().det() > 0) return;
    for (Triangle& t : mesh.triangles) std::swap(t[0], t[2]);
    for (Quad& q : mesh.quads) std::swap(q[1], q[3]);
}

Mesh inIndexSpace(const openvdb::FloatGrid& grid, Mesh mesh) {
    for (Vec3f& p : mesh.points)
        p = cast<float>(fromVec(grid.worldToIndex(toVec(cast<double>(p) + mesh.origin))));
    mesh.origin = {0, 0, 0};
    return mesh;
}

}  // namespace

void validate(const MeshingOptions& options) {
    requireOption(options.adaptivity >= 0 && options.adaptivity <= 1, "adaptivity",
                  roundedText(options.adaptivity, 6), "from 0 to 1");
    if (options.sharp && options.adaptivity > 0)
        throw Error(ErrorCode::InvalidOption, "`sharp` and `adaptivity`: give one of them");
}

Mesh levelSetToMesh(const openvdb::FloatGrid& grid, const MeshingOptions& options, const RunContext& ctx) {
    validate(options);
    Stage stage(ctx, "level set to mesh", 2);
    Mesh mesh;
    if (options.sharp) {
        std::optional<Mesh> source;
        if (options.source) source = inIndexSpace(grid, *options.source);
        mesh = sharpZeroLevel(grid, source ? &*source : nullptr, ctx);
    } else {
        mesh = zeroLevelInIndexSpace(grid, options.adaptivity, ctx);
    }
    if (mesh.faceCount() == 0) throw Error(ErrorCode::EmptyInput, "the level set has no surface to mesh");
    stage.advance();
    separateNonManifold(mesh, kGap);
    toWorld(grid, mesh);
    stage.advance();
    return mesh;
}

}  // namespace vdbsynth
