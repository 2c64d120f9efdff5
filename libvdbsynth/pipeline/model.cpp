#include "libvdbsynth/pipeline/model.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/mesh_conversion.h"
#include "libvdbsynth/vdb/redistance.h"
#include "libvdbsynth/vdb/vdb_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vdbsynth {
namespace {

double longestSide(const std::string& path, const Mesh& mesh) {
    Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    const auto add = [&](std::uint32_t i) {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], double(mesh.points[i][axis]));
            high[axis] = std::max(high[axis], double(mesh.points[i][axis]));
        }
    };
    for (const Triangle& t : mesh.triangles)
        for (std::uint32_t i : t) add(i);
    for (const Quad& q : mesh.quads)
        for (std::uint32_t i : q) add(i);
    const double side = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    if (!(side > 0)) throw Error(ErrorCode::Unusable, path + ": all faces lie in one point");
    return side;
}

LevelSet loadMesh(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    const Mesh mesh = readMesh(path, ctx);
    double voxelSize = options.voxelSize;
    if (voxelSize == 0) {
        const int resolution = options.resolution > 0 ? options.resolution : kDefaultResolution;
        voxelSize = longestSide(path, mesh) / resolution;
        char text[128];
        std::snprintf(text, sizeof text, ": voxel size %.6g (%d voxels along the longest side%s)", voxelSize,
                      resolution, options.resolution > 0 ? "" : "; --resolution or --voxel-size sets it");
        message(ctx, options.resolution > 0 ? MessageLevel::Detail : MessageLevel::Note, path + text);
    }
    LevelSet model;
    model.grid = meshToSolid(mesh, voxelSize, options.halfWidth, path, options.solid, ctx);
    model.domain = solidBox(*model.grid, path);
    stampLevelSet(model);
    return model;
}

// A level set at the voxel size asked for: its own if none is.
LevelSet atVoxelSize(const std::string& path, const LevelSet& model, const ModelOptions& options,
                     const RunContext& ctx) {
    const double present = voxelSizeOf(*model.grid);
    const Index3 size = model.domain.size();
    const double wanted = options.voxelSize > 0 ? options.voxelSize
                          : options.resolution > 0
                              ? present * std::max({size.x, size.y, size.z}) / options.resolution
                              : present;
    if (std::abs(wanted - present) <= 1e-6 * present) return model;
    char text[128];
    std::snprintf(text, sizeof text, ": resampled from voxels of %.6g to %.6g", present, wanted);
    message(ctx, MessageLevel::Note, path + text);
    return resampled(model, wanted, ctx);
}

}  // namespace

bool isMeshPath(const std::string& path) {
    MeshFormat format{};
    return meshFormatOf(path, format);
}

bool isModelPath(const std::string& path) {
    return readExtensionOf(path) == "vdb" || isMeshPath(path);
}

void requireModelPath(const std::string& path) {
    if (isModelPath(path)) return;
    throw Error(
        ErrorCode::InvalidOption,
        path + ": unknown extension; models are .vdb, .obj, .ply, .stl, .off or .mesh, each also with .gz");
}

LevelSet loadModel(const std::string& path, const ModelOptions& options, const RunContext& ctx) {
    requireModelPath(path);
    requireOption(options.voxelSize >= 0 && options.voxelSize < 1e30, "voxel-size",
                  std::to_string(options.voxelSize), "above 0 (world)");
    requireOption(options.resolution == 0 || (options.resolution >= 2 && options.resolution <= 100000),
                  "resolution", std::to_string(options.resolution), "a whole number from 2 to 100000");
    requireOption(options.halfWidth >= 1.5 && options.halfWidth <= 100, "half-width",
                  std::to_string(options.halfWidth), "from 1.5 to 100 voxels");
    const ThreadLimit limit(ctx);
    if (isMeshPath(path)) return loadMesh(path, options, ctx);
    VdbReadOptions read;
    read.gridName = options.grid;
    read.iso = options.iso;
    return atVoxelSize(path, readVdbModel(path, read, ctx), options, ctx);
}

LevelSet withHalfWidth(const LevelSet& model, double halfWidth, const RunContext& ctx) {
    requireOption(halfWidth >= 1.5 && halfWidth <= 100, "half-width", std::to_string(halfWidth),
                  "from 1.5 to 100 voxels");
    const double present = halfWidthOf(*model.grid);
    if (std::abs(present - halfWidth) < 1e-3 * halfWidth) return model;
    const ThreadLimit limit(ctx);
    message(ctx, MessageLevel::Detail,
            "the band of " + std::to_string(present) + " voxels a side is re-distanced to " +
                std::to_string(halfWidth));
    LevelSet result = model;
    result.grid = rebuildLevelSet(*model.grid, float(halfWidth), "the model", ctx);
    stampLevelSet(result);
    return result;
}

}  // namespace vdbsynth
