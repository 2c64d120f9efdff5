#include "libvdbsynth/pipeline/relief/relief_outputs.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

bool isImage(const std::string& path) {
    return extensionOf(path) == "png" || extensionOf(path) == "exr";
}
bool isSurface(const std::string& path) {
    MeshFormat format{};
    return extensionOf(path) != "ply" && writableMeshFormatOf(path, format);
}

// Relief at vertices [world] of the base's mesh.
void addRelief(const ReliefExtraction& extraction, Mesh& mesh, const RunContext& ctx) {
    Attribute relief{"relief", 1, std::vector<float>(mesh.points.size())};
    Attribute vector{"relief_vector", 3, std::vector<float>(3 * mesh.points.size())};
    const openvdb::math::Transform& transform = extraction.base.grid->transform();
    const IndexBox& box = extraction.domain;
    parallelFor(ctx, mesh.points.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3d world = cast<double>(mesh.points[i]) + mesh.origin;
            const openvdb::Vec3d at = transform.worldToIndex(openvdb::Vec3d(world.x, world.y, world.z));
            const Vec3f foot{float(at.x() - extraction.corner.x), float(at.y() - extraction.corner.y),
                             float(at.z() - extraction.corner.z)};
            bool within = true;
            for (int axis = 0; axis < 3; ++axis)
                within = within && foot[axis] >= float(box.min[axis]) && foot[axis] <= float(box.max[axis]);
            if (!within) continue;
            const Vec3f normal = normalized(sampleGradient(extraction.fields.distance, foot));
            const ReliefPoint point = reliefAt(extraction.fields, foot, normal);
            const Vec3f v = point.folds ? point.vector : normal * point.height;
            const openvdb::Vec3d moved =
                transform.indexToWorld(at + openvdb::Vec3d(v.x, v.y, v.z)) - transform.indexToWorld(at);
            relief.values[i] = point.height * float(extraction.voxelSize);
            for (int axis = 0; axis < 3; ++axis)
                vector.values[3 * i + std::size_t(axis)] = float(moved[axis]);
        }
    });
    mesh.attributes = {std::move(relief), std::move(vector)};
}

void writeImage(const ReliefExtraction& extraction, const std::string& path, const std::string& temporary,
                const RunContext& ctx) {
    ReliefImage image = reliefImage(extraction, ctx);
    if (extensionOf(path) == "exr") return writeGreyExr(temporary, image.columns, image.rows, image.heights);
    float low = 1e30f, high = -1e30f;
    for (const float height : image.heights) {
        if (std::isnan(height)) continue;
        low = std::min(low, height);
        high = std::max(high, height);
    }
    message(ctx, MessageLevel::Note,
            path + ": black is a height of " + roundedText(double(low), 6) + ", white one of " +
                roundedText(double(high), 6) + " (world)");
    for (float& height : image.heights) height = high > low ? (height - low) / (high - low) : height * 0;
    writeGreyPng(temporary, image.columns, image.rows, image.heights);
}

std::vector<GridPtr> gridsOf(const ReliefExtraction& extraction) {
    std::vector<GridPtr> grids{extraction.base.grid, extraction.relief};
    if (extraction.reliefVector) grids.push_back(extraction.reliefVector);
    if (extraction.surface.grid) grids.push_back(extraction.surface.grid);
    return grids;
}

}  // namespace

void requireReliefPaths(const std::vector<std::string>& paths, const ReliefExtractOptions& options) {
    for (const std::string& path : paths) {
        if (isSurface(path) && !options.strength)
            throw Error(
                ErrorCode::InvalidOption,
                path +
                    ": holds base + strength * relief; give `strength`, or write the relief to .vdb or "
                    ".ply");
        if (extensionOf(path) != "vdb" && extensionOf(path) != "ply" && !isImage(path) && !isSurface(path))
            throw Error(ErrorCode::InvalidOption,
                        path +
                            ": unknown extension; outputs are .vdb and .ply, .png and .exr of flat models, "
                            "and with a strength .obj, .stl, .off, .glb and .gltf");
    }
}

void writeRelief(const ReliefExtraction& extraction, const std::vector<std::string>& paths,
                 const ReliefExtractOptions& options, const VdbMetadata& metadata, OutputSet& outputs,
                 const RunContext& ctx) {
    requireReliefPaths(paths, options);
    std::vector<std::string> surfaces;
    for (const std::string& path : paths) {
        if (isSurface(path)) {
            surfaces.push_back(path);
            continue;
        }
        Stage stage(ctx, "writing " + path, 1);
        const std::string temporary = outputs.add(path);
        if (extensionOf(path) == "vdb") {
            writeVdb(temporary, gridsOf(extraction), metadata);
        } else if (isImage(path)) {
            writeImage(extraction, path, temporary, ctx);
        } else {
            Mesh mesh = levelSetToMesh(*extraction.base.grid, {}, ctx);
            addRelief(extraction, mesh, ctx);
            writeMesh(temporary, MeshFormat::Ply, mesh);
        }
        stage.advance();
    }
    if (!surfaces.empty()) writeModel(extraction.surface, surfaces, {}, outputs, ctx);
}

}  // namespace vdbsynth
