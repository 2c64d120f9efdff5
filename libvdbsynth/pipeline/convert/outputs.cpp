#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/raster/height_field.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/distance/close_field.h"
#include "libvdbsynth/geometry/sliver_removal.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/model_unit.h"
#include "libvdbsynth/vdb/bricks.h"
#include "libvdbsynth/vdb/convert/attribute_grids.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "libvdbsynth/vdb/convert/level_set_to_points.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vdbsynth {
namespace {

bool isHeightPath(const std::string& path) {
    return extensionOf(path) == "png" || extensionOf(path) == "exr";
}

// Heights in world units: EXR holds them unchanged; in PNG black is zero, or the lowest if that is below
// zero, and white is the highest, or the requested height.
void writeHeights(const LevelSet& model, const std::string& path, const std::string& temporary,
                  const ModelOutputOptions& options, const RunContext& ctx) {
    requireMemory(ctx, double(model.domain.volume()) * 8.0 / 512, path, "crop the model");
    const int axis = options.plane == HeightPlane::XY ? 2 : options.plane == HeightPlane::YZ ? 0 : 1;
    // The caps at the sides of a recorded domain are not part of the surface.
    CutFaces cut{};
    for (std::size_t face = 0; face < 6; ++face) cut[face] = model.domainRecorded && int(face / 2) != axis;
    const BrickField field = gatherWideBand(*model.grid, model.domain, cut, kHalfWidth, ctx);
    HeightImage image = topHeights(field, options.plane, ctx);
    float low = 0, high = 0;
    std::size_t missing = 0;
    for (float& height : image.heights) {
        if (std::isnan(height)) {
            ++missing;
            continue;
        }
        openvdb::Vec3d place(0.0);
        place[axis] = double(height) + model.domain.min[axis];
        height = float(model.grid->indexToWorld(place)[axis]);
        low = std::min(low, height);
        high = std::max(high, height);
    }
    if (missing == image.heights.size())
        throw Error(ErrorCode::EmptyInput, path + ": no column of the domain meets a surface");
    if (missing > 0)
        message(ctx, MessageLevel::Note,
                path + ": " + std::to_string(missing) + " of " + std::to_string(image.heights.size()) +
                    " pixels meet no surface; they are transparent");
    if (extensionOf(path) == "exr") return writeGreyExr(temporary, image.columns, image.rows, image.heights);
    if (options.height > 0) high = float(options.height);
    message(ctx, MessageLevel::Note,
            path + ": black is a height of " + roundedText(double(low), 6) + ", white one of " +
                roundedText(double(high), 6) + " (world)");
    for (float& height : image.heights) height = high > low ? (height - low) / (high - low) : 0;
    writeGreyPng(temporary, image.columns, image.rows, image.heights);
}

// STL has floats only, which far from zero are no finer than some step.
void warnOfSteps(const std::string& path, const Mesh& mesh, const RunContext& ctx) {
    const double farthest =
        std::max({std::abs(mesh.origin.x), std::abs(mesh.origin.y), std::abs(mesh.origin.z)});
    if (farthest == 0) return;
    message(ctx, MessageLevel::Warning,
            path + ": so far from zero the coordinates of .stl have steps of " +
                roundedText(std::ldexp(1.0, std::ilogb(farthest) - 23), 2) +
                "; .ply, .obj, .off and .glb keep them");
}

void sayLost(const std::string& path, const Mesh& mesh, const RunContext& ctx) {
    const std::string lost = lostIn3mf(mesh);
    if (!lost.empty())
        message(ctx, MessageLevel::Note,
                path + ": .3mf has no place for " + lost + "; .ply and .glb hold all attributes");
    message(ctx, MessageLevel::Detail, path + ": a unit of the world is a millimetre");
}

constexpr double kSliverTolerance = 0.2;  // [voxels] that removing slivers may move the surface

// Merging flat parts leaves triangles of all shapes; without merging there are few slivers.
void removeSliversOfMerging(const LevelSet& model, Mesh& mesh, const RunContext& ctx) {
    SliverOptions options;
    options.tolerance = kSliverTolerance * voxelSizeOf(*model.grid);
    const SliverResult result = removeSlivers(mesh, options, ctx);
    message(ctx, MessageLevel::Detail,
            "mesh: removed " + std::to_string(result.before - result.left) + " of " +
                std::to_string(result.before) + " slivers (an angle under " + roundedText(options.angle, 3) +
                " degrees), left " + std::to_string(result.left) + " in " +
                std::to_string(mesh.triangles.size()) + " triangles");
}

// The same tree under another name or precision.
GridPtr asWritten(const GridPtr& grid, const std::string& name, bool half) {
    if (name.empty() && !half) return grid;
    const GridPtr written = grid->copyGrid();
    if (!name.empty()) written->setName(name);
    if (half) written->setSaveFloatAsHalf(true);
    return written;
}

void writeOne(const LevelSet& model, const std::string& path, const std::string& temporary,
              const ModelOutputOptions& options, std::optional<Mesh>& mesh, const RunContext& ctx) {
    if (extensionOf(path) == "vdb") {
        for (const GridPtr& grid : model.attributes)
            if (grid->getName() == options.name)
                throw Error(ErrorCode::InvalidOption,
                            "`name` " + options.name +
                                ": a grid of that name is transferred as well; give another name");
        std::vector<GridPtr> grids{asWritten(model.grid, options.name, options.half)};
        for (const GridPtr& grid : model.attributes) grids.push_back(asWritten(grid, "", options.half));
        grids.insert(grids.end(), options.extraGrids.begin(), options.extraGrids.end());
        writeVdb(temporary, grids, options.metadata);
        return;
    }
    if (isHeightPath(path)) return writeHeights(model, path, temporary, options, ctx);
    VolumeFormat volume{};
    if (volumeFormatOf(path, volume)) return writeModelVolume(model, path, temporary, options.values, ctx);
    if (options.points) {
        PointOptions pointOptions;
        pointOptions.spacing = options.spacing;
        PointCloud cloud = levelSetToPoints(*model.grid, pointOptions, ctx);
        cloud.attributes = gridsToAttributes(model.attributes, cloud.points, cloud.origin, ctx);
        writePointsPly(temporary, cloud);
        return;
    }
    if (!mesh) {
        MeshingOptions meshing;
        meshing.adaptivity = options.adaptivity;
        meshing.sharp = options.sharp;
        meshing.source = model.source.get();
        mesh = levelSetToMesh(*model.grid, meshing, ctx);
        if (options.adaptivity > 0) removeSliversOfMerging(model, *mesh, ctx);
        mesh->attributes = gridsToAttributes(model.attributes, mesh->points, mesh->origin, ctx);
    }
    MeshFormat format{};
    writableMeshFormatOf(path, format);
    if (format == MeshFormat::Stl) warnOfSteps(path, *mesh, ctx);
    if (format == MeshFormat::ThreeMf) sayLost(path, *mesh, ctx);
    writeMesh(temporary, format, *mesh);
}

}  // namespace

void requireOutputPaths(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
        MeshFormat format{};
        VolumeFormat volume{};
        if (extensionOf(path) != "vdb" && !isHeightPath(path) && !writableMeshFormatOf(path, format) &&
            !volumeFormatOf(path, volume))
            throw Error(
                ErrorCode::InvalidOption,
                path +
                    ": unknown extension; outputs are .vdb, .obj, .ply, .stl, .off, .glb, .gltf, .3mf, or "
                    ".png and .exr for heights, or volumes as " +
                    kVolumeOutputs);
    }
}

namespace {

void writeAll(const LevelSet& model, const std::vector<std::string>& paths, const ModelOutputOptions& options,
              OutputSet& outputs, const RunContext& ctx) {
    std::vector<std::string> temporaries;
    for (const std::string& path : paths) temporaries.push_back(outputs.add(path));
    std::optional<Mesh> mesh;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        Stage stage(ctx, "writing " + paths[i], 1);
        writeOne(model, paths[i], temporaries[i], options, mesh, ctx);
        stage.advance();
    }
}

}  // namespace

void validate(const ModelOutputOptions& options) {
    MeshingOptions meshing;
    meshing.adaptivity = options.adaptivity;
    meshing.sharp = options.sharp;
    validate(meshing);
    PointOptions points;
    points.spacing = options.spacing;
    validate(points);
    requireOption(options.height >= 0 && options.height < 1e30, "height", roundedText(options.height, 6),
                  "above 0 (world), or 0 for the highest point");
    for (const GridPtr& grid : options.extraGrids)
        requireOption(grid != nullptr, "extraGrids", "null", "grids");
}

void writeModel(const LevelSet& model, const std::vector<std::string>& paths,
                const ModelOutputOptions& options, OutputSet& outputs, const RunContext& ctx) {
    requireOutputPaths(paths);
    withThreads(ctx, [&] {
        validate(options);
        requireModel(&model, "the model", ctx);
        writeAll(inUnit(model, options.unit), paths, options, outputs, ctx);
    });
}

}  // namespace vdbsynth
