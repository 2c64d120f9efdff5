#include "libvdbsynth/vdb/convert/mesh_to_level_set.h"
#include "libvdbsynth/distance/rebuild_band.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/far_grid.h"
#include "libvdbsynth/vdb/convert/mesh_to_level_set_steps.h"
#include "libvdbsynth/vdb/convert/surface_kept.h"
#include "libvdbsynth/vdb/wall.h"

#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/geometry/mesh_check.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/solid/mesh_parts.h"
#include "libvdbsynth/vdb/coord.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace vdbsynth {
namespace {

// Memory per voxel of the band, OpenVDB's tree included, averaged over the faces: measured on bunny, dragon
// and nefertiti at 100 to 1000 voxels.
constexpr double kBytesPerBandVoxel = 24;

// Volumes of a mesh and of its level set, in world units.
struct Volumes {
    double enclosed = 0, signedVolume = 0, area = 0;
};

Volumes volumesOf(const openvdb::FloatGrid& grid, const Mesh& mesh, double voxelSize) {
    Volumes volumes;
    volumes.enclosed = solidVoxels(grid) * voxelSize * voxelSize * voxelSize;
    double &volume = volumes.signedVolume, &area = volumes.area;
    const Vec3d origin =
        cast<double>(mesh.points[mesh.triangles.empty() ? mesh.quads[0][0] : mesh.triangles[0][0]]);
    const auto add = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        const Vec3d a = cast<double>(mesh.points[i]) - origin, b = cast<double>(mesh.points[j]) - origin,
                    c = cast<double>(mesh.points[k]) - origin;
        volume += dot(a, cross(b, c)) / 6;
        area += length(cross(b - a, c - a)) / 2;
    };
    for (const Triangle& t : mesh.triangles) add(t[0], t[1], t[2]);
    for (const Quad& q : mesh.quads) {
        add(q[0], q[1], q[2]);
        add(q[0], q[2], q[3]);
    }
    return volumes;
}

// OpenVDB fills voids that no path from outside reaches; a mesh may intend them as cavities. Voxels at the
// surface alone can make a difference of a small part of a voxel's depth.
bool lostCavities(const Volumes& v, double voxelSize) {
    return v.enclosed - std::abs(v.signedVolume) > 0.25 * v.area * voxelSize;
}

// Voxel centres that happen to lie on a sheet count as inside: about a voxel of depth over its area.
bool sheetOnly(const Volumes& v, double voxelSize) {
    return v.enclosed < 1.5 * v.area * voxelSize && v.enclosed > 2 * std::abs(v.signedVolume);
}

// Empty if a level set encloses its mesh's volume, else the problem.
std::string missingVolume(const Volumes& volumes, const Mesh& mesh, double voxelSize) {
    const double enclosed = volumes.enclosed, volume = volumes.signedVolume, area = volumes.area;
    if (!sheetOnly(volumes, voxelSize) && enclosed >= 0.5 * std::abs(volume) && enclosed > 0) return "";
    const MeshSummary summary = summarize(mesh);
    if (summary.openEdges == 0 && enclosed > 0 && enclosed >= 0.5 * std::abs(volume)) return "";
    if (summary.openEdges == 0 && std::abs(volume) > 0 && std::abs(volume) < area * voxelSize)
        return "thinner than a voxel; use a smaller `voxelSize` or a larger `resolution`";
    if (summary.openEdges == 0)
        return "no open edges, but the level set encloses under half of the faces' volume; its shells "
               "overlap or are duplicated; merge them or make a shell with `open` shell and a `thickness`";
    return std::to_string(summary.openEdges) +
           " open edges; close the mesh or make a shell with `open` shell and a `thickness` (the level set "
           "encloses " +
           std::to_string(int(std::abs(volume) > 0 ? 100 * enclosed / std::abs(volume) : 0)) +
           " % of the faces' volume)";
}

}  // namespace

void requireBandMemory(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                       const RunContext& ctx) {
    double area = 0;
    for (const Triangle& t : mesh.triangles)
        area += double(length(
                    cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]))) /
                2;
    for (const Quad& q : mesh.quads)
        area += double(length(
                    cross(mesh.points[q[2]] - mesh.points[q[0]], mesh.points[q[3]] - mesh.points[q[1]]))) /
                2;
    requireMemory(ctx, area / (voxelSize * voxelSize) * 2 * halfWidth * kBytesPerBandVoxel,
                  name + ": a level set at voxel size " + std::to_string(voxelSize),
                  "use a larger `voxelSize` or a smaller `resolution`");
}

Mesh inVoxels(const Mesh& mesh, double voxelSize) {
    Mesh index = mesh;
    for (Vec3f& p : index.points) p = cast<float>(cast<double>(p) * (1 / voxelSize));
    return index;
}

namespace {

void checkOptions(double voxelSize, double halfWidth) {
    requireOption(std::isfinite(voxelSize) && voxelSize > 0, "voxelSize", std::to_string(voxelSize),
                  "above 0");
    requireOption(halfWidth >= 1.5 && halfWidth <= 1000, "halfWidth", std::to_string(halfWidth),
                  "from 1.5 to 1000 voxels");
}

struct Faces {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
};

Faces facesOf(const Mesh& mesh) {
    Faces faces;
    faces.points.reserve(mesh.points.size());
    for (const Vec3f& p : mesh.points) faces.points.emplace_back(p.x, p.y, p.z);
    faces.triangles.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) faces.triangles.emplace_back(t[0], t[1], t[2]);
    faces.quads.reserve(mesh.quads.size());
    for (const Quad& q : mesh.quads) faces.quads.emplace_back(q[0], q[1], q[2], q[3]);
    return faces;
}

// As OpenVDB's meshToLevelSet, without its final smoothing.
openvdb::FloatGrid::Ptr unsmoothed(openvdb::util::NullInterrupter& interrupter,
                                   const openvdb::math::Transform& transform, Faces faces, float halfWidth) {
    for (openvdb::Vec3s& p : faces.points) p = openvdb::Vec3s(transform.worldToIndex(p));
    for (const openvdb::Vec3I& t : faces.triangles)
        faces.quads.emplace_back(t[0], t[1], t[2], openvdb::util::INVALID_IDX);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> adapter(faces.points,
                                                                                             faces.quads);
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        interrupter, adapter, transform, halfWidth, halfWidth, openvdb::tools::DISABLE_RENORMALIZATION);
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

FloatGridPtr openVdbLevelSet(const Mesh& mesh, double voxelSize, double halfWidth, bool exact,
                             const std::string& name, const RunContext& ctx) {
    requireBandMemory(mesh, voxelSize, halfWidth, name, ctx);
    Stage stage(ctx, "mesh to level set", 1);
    const Faces faces = facesOf(mesh);
    return behindWall(ErrorCode::Unusable, name, [&] {
        Interrupter interrupter(ctx);
        openvdb::util::NullInterrupter& base = interrupter;
        const auto transform = openvdb::math::Transform::createLinearTransform(voxelSize);
        const openvdb::FloatGrid::Ptr grid = withThreads(ctx, [&] {
            return exact
                       ? unsmoothed(base, *transform, faces, float(halfWidth))
                       : openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
                             base, *transform, faces.points, faces.triangles, faces.quads, float(halfWidth));
        });
        throwIfCancelled(ctx);
        stage.advance();
        return FloatGridPtr(grid);
    });
}

// True if a voxel at the surface has an inactive neighbour: OpenVDB drops voxels where sheets coincide.
bool hasGaps(const openvdb::FloatGrid& grid, const RunContext& ctx) {
    const openvdb::tree::LeafManager<const openvdb::FloatTree> leaves(grid.tree());
    const float near = 0.9f * float(voxelSizeOf(grid));
    std::atomic<bool> found{false};
    parallelFor(ctx, leaves.leafCount(), 64, [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (std::size_t i = begin; i < end && !found.load(std::memory_order_relaxed); ++i)
            for (auto voxel = leaves.leaf(i).cbeginValueOn(); voxel; ++voxel) {
                if (std::abs(*voxel) >= near) continue;
                const openvdb::Coord c = voxel.getCoord();
                for (const Index3& step : kFaceNeighbours)
                    if (!accessor.isValueOn(c + toCoord(step))) found.store(true, std::memory_order_relaxed);
            }
    });
    return found.load();
}

}  // namespace

void validate(const SolidOptions& options) {
    requireOption(options.open != OpenMesh::Shell || (options.thickness > 0 && options.thickness < 1e30),
                  "thickness", roundedText(options.thickness, 6), "above 0 (world)");
}

FloatGridPtr tryOpenVdb(const Mesh& mesh, const Conversion& to) {
    const FloatGridPtr grid =
        openVdbLevelSet(mesh, to.voxelSize, to.halfWidth, to.options.exact, to.name, to.ctx);
    const Volumes volumes = volumesOf(*grid, mesh, to.voxelSize);
    return sheetOnly(volumes, to.voxelSize) || lostCavities(volumes, to.voxelSize) || hasGaps(*grid, to.ctx)
               ? nullptr
               : grid;
}

namespace {

FloatGridPtr shellOf(const Mesh& mesh, const Conversion& to) {
    const double thickness = to.options.thickness / to.voxelSize;
    requireBandMemory(mesh, to.voxelSize, to.halfWidth + thickness, to.name, to.ctx);
    Stage stage(to.ctx, "mesh to level set", 1);
    const BrickField field = sheetToField(inVoxels(mesh, to.voxelSize), thickness, to.ctx);
    stage.advance();
    return levelSetOf(field, to.voxelSize, float(to.halfWidth), to.name, to.ctx);
}

}  // namespace

FloatGridPtr meshToSolid(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                         const SolidOptions& options, const RunContext& ctx) {
    checkOptions(voxelSize, halfWidth);
    requireVoxelSize(voxelSize, name);
    requireMesh(mesh, name);
    validate(options);
    const bool shell = options.open == OpenMesh::Shell;
    requireOption(!shell || options.thickness >= voxelSize, "thickness", std::to_string(options.thickness),
                  "at least a voxel, which is " + std::to_string(voxelSize));
    const Conversion to{voxelSize, halfWidth, options, name, ctx};
    const WholeVoxels place = wholeVoxels(mesh.origin, voxelSize);
    Mesh near;
    if (!place.none()) {
        near = mesh;
        near.origin = {0, 0, 0};
        for (Vec3f& p : near.points) p = cast<float>(cast<double>(p) + place.rest);
    }
    const Mesh& local = place.none() ? mesh : near;
    return movedBy(shell ? shellOf(local, to) : solidOf(local, to), place, name, ctx);
}

FloatGridPtr levelSetOf(const BrickField& field, double voxelSize, float halfWidth, const std::string& name,
                        const RunContext& ctx) {
    RebuildOptions options;
    options.halfWidth = halfWidth;
    return levelSetFrom(rebuiltBand(field, options, ctx), halfWidth, voxelSize, name, ctx);
}

FloatGridPtr meshToLevelSet(const Mesh& mesh, double voxelSize, double halfWidth, const std::string& name,
                            const RunContext& ctx) {
    checkOptions(voxelSize, halfWidth);
    requireMesh(mesh, name);
    const FloatGridPtr grid = openVdbLevelSet(mesh, voxelSize, halfWidth, /* exact= */ false, name, ctx);
    const std::string wrong = missingVolume(volumesOf(*grid, mesh, voxelSize), mesh, voxelSize);
    if (!wrong.empty()) throw Error(ErrorCode::Unusable, name + ": " + wrong);
    return grid;
}

}  // namespace vdbsynth
