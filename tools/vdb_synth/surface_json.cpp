#include "tools/vdb_synth/surface_json.h"

#include "libvdbsynth/solid/mesh_parts.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {

nlohmann::ordered_json surfaceJson(const Mesh& mesh, const RunContext& ctx) {
    const auto triple = [](const Vec3d& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); };
    const MeshSummary summary = summarize(mesh);
    Mesh welded = mesh;
    weldVertices(welded);
    const PartCounts parts = countParts(meshParts(welded, ctx));
    return {{"bounds_min", triple(summary.boxMin)},
            {"bounds_max", triple(summary.boxMax)},
            {"area", summary.area},
            {"signed_volume", summary.signedVolume},
            {"closed_parts", parts.solids},
            {"voids", parts.cavities},
            {"united_parts", parts.united},
            {"open_parts", parts.open}};
}

}  // namespace vdbsynth::cli
