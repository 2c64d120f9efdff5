// Closed solids from any mesh: prepared, its parts oriented, by OpenVDB where that does well, else by winding
// numbers.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set_steps.h"
#include "libvdbsynth/vdb/convert/surface_kept.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <string>
#include <utility>

namespace vdbsynth {
namespace {

// True for a mesh that OpenVDB converts well. Duplicate faces leave gaps in its band.
bool boundsSolid(const Mesh& mesh) {
    const EdgeBalance balance = edgeBalance(mesh);
    if (balance != EdgeBalance::Balanced) return balance == EdgeBalance::Manifold;
    Mesh copy = mesh;
    return removeDuplicateFaces(copy) == 0;
}

// Faces that bound a solid by the winding number, and what was done for it.
struct Prepared {
    Mesh mesh;
    bool balanced = false, cavities = false;
    std::string found;
};

bool hasCavities(const MeshParts& parts) {
    return std::any_of(parts.parts.begin(), parts.parts.end(),
                       [](const MeshPart& part) { return part.role == PartRole::Cavity; });
}

void noteTurned(const OrientedParts& oriented, const PartCounts& counts, const std::string& name,
                const RunContext& ctx) {
    const auto parts = [](std::size_t count) { return countText(count, "part"); };
    if (oriented.flipped > 0)
        message(ctx, MessageLevel::Note,
                name + ": the normals of " + parts(oriented.flipped) + " turned: outermost parts are solid" +
                    (counts.cavities > 0 ? ", opposed ones in them are voids" : ""));
    if (counts.united > 0)
        message(
            ctx, MessageLevel::Note,
            name + ": " + parts(counts.united) +
                " inside another, with normals as its own, united with it; opposed normals make a void, or "
                "in a void a solid");
}

// Welds, removes duplicates and orients.
Prepared prepare(const Mesh& mesh, const std::string& name, const RunContext& ctx) {
    Prepared prepared;
    prepared.mesh = mesh;
    weldVertices(prepared.mesh);
    const std::size_t duplicates = removeDuplicateFaces(prepared.mesh);
    if (prepared.mesh.faceCount() == 0) throw Error(ErrorCode::Unusable, name + ": no face has an area");
    prepared.balanced = duplicates == 0 && isBalanced(prepared.mesh);
    const std::size_t flipped = prepared.balanced ? 0 : orientFaces(prepared.mesh);
    const MeshParts parts = meshParts(prepared.mesh, ctx);
    prepared.cavities = hasCavities(parts);
    OrientedParts oriented = orientParts(prepared.mesh, parts);
    if (oriented.mesh) prepared.mesh = std::move(*oriented.mesh);
    if (!prepared.balanced) {
        prepared.balanced = isBalanced(prepared.mesh);
        const MeshSummary summary = summarize(prepared.mesh);
        const auto add = [&](std::size_t count, const char* what, const char* more = "") {
            if (count > 0)
                prepared.found += (prepared.found.empty() ? "" : ", ") + countText(count, what) + more;
        };
        add(summary.openEdges, "open edge");
        add(summary.nonManifoldEdges, "edge", " of more than two faces");
        add(duplicates, "duplicate face");
        add(flipped, "flipped face");
    }
    noteTurned(oriented, countParts(parts), name, ctx);
    return prepared;
}

// The same of a mesh with voids in it.
FloatGridPtr tryNested(const Mesh& mesh, const MeshParts& parts, const Conversion& to) {
    FloatGridPtr whole;
    bool isVoid = false;
    for (const Mesh& level : nestedMeshes(mesh, parts)) {
        const FloatGridPtr grid = tryOpenVdb(level, to);
        if (!grid) return nullptr;
        if (whole)
            addNested(*whole, *grid, isVoid, to.name);
        else
            whole = grid;
        isVoid = !isVoid;
    }
    return whole;
}

// The mesh as it is, its parts oriented, if OpenVDB converts it well; else null.
FloatGridPtr solidAsIs(const Mesh& mesh, const Conversion& to) {
    if (!boundsSolid(mesh)) return nullptr;
    const MeshParts parts = meshParts(mesh, to.ctx);
    const OrientedParts oriented = orientParts(mesh, parts);
    const Mesh& use = oriented.mesh ? *oriented.mesh : mesh;
    const FloatGridPtr grid = hasCavities(parts) ? tryNested(mesh, parts, to) : tryOpenVdb(use, to);
    if (!grid) return nullptr;
    noteTurned(oriented, countParts(parts), to.name, to.ctx);
    requireKept(inVoxels(use, to.voxelSize), *grid, to.name, to.ctx);
    return grid;
}

FloatGridPtr solidByWinding(const Mesh& indexMesh, const Conversion& to) {
    Stage stage(to.ctx, "mesh to level set", 1);
    const BrickField field = soupToField(indexMesh, to.name, to.ctx);
    stage.advance();
    float value = 0;
    if (field.constantIn(field.box(), value)) {
        // Nothing is inside, which the comparison with the mesh will say.
        const FloatGridPtr none = openvdb::FloatGrid::create(float(to.halfWidth * to.voxelSize));
        none->setTransform(openvdb::math::Transform::createLinearTransform(to.voxelSize));
        return none;
    }
    return levelSetOf(field, to.voxelSize, float(to.halfWidth), to.name, to.ctx);
}

}  // namespace

FloatGridPtr solidOf(const Mesh& mesh, const Conversion& to) {
    if (const FloatGridPtr grid = solidAsIs(mesh, to)) return grid;
    Prepared prepared = prepare(mesh, to.name, to.ctx);
    FloatGridPtr grid;
    if (prepared.balanced && !prepared.cavities) grid = tryOpenVdb(prepared.mesh, to);
    if (!prepared.found.empty())
        message(to.ctx, MessageLevel::Warning,
                to.name + ": " + prepared.found +
                    (grid ? "; reoriented" : "; inside is where the winding number is over a half"));
    const Mesh indexMesh = inVoxels(prepared.mesh, to.voxelSize);
    if (!grid) {
        requireBandMemory(mesh, to.voxelSize, to.halfWidth, to.name, to.ctx);
        grid = solidByWinding(indexMesh, to);
    }
    requireKept(indexMesh, *grid, to.name, to.ctx);
    return grid;
}

}  // namespace vdbsynth
