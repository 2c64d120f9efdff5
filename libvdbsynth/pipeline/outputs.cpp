#include "libvdbsynth/pipeline/outputs.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/vdb/mesh_conversion.h"

#include <openvdb/openvdb.h>

#include <optional>

namespace vdbsynth {
namespace {

void writeOne(const LevelSet& model, const std::string& path, const std::string& temporary,
              const ModelOutputOptions& options, std::optional<Mesh>& mesh, const RunContext& ctx) {
    if (extensionOf(path) == "vdb") {
        std::vector<GridPtr> grids{model.grid};
        grids.insert(grids.end(), options.extraGrids.begin(), options.extraGrids.end());
        writeVdb(temporary, grids, options.metadata);
        return;
    }
    if (options.points) {
        PointOptions pointOptions;
        pointOptions.spacing = options.spacing;
        writePointsPly(temporary, levelSetToPoints(*model.grid, pointOptions, ctx));
        return;
    }
    if (!mesh) {
        MeshingOptions meshing;
        meshing.adaptivity = options.adaptivity;
        mesh = levelSetToMesh(*model.grid, meshing, ctx);
    }
    MeshFormat format{};
    writableMeshFormatOf(path, format);
    writeMesh(temporary, format, *mesh);
}

}  // namespace

void requireOutputPaths(const std::vector<std::string>& paths) {
    for (const std::string& path : paths) {
        MeshFormat format{};
        if (extensionOf(path) != "vdb" && !writableMeshFormatOf(path, format))
            throw Error(ErrorCode::InvalidOption,
                        path + ": unknown extension; outputs are .vdb, .obj, .ply, .stl or .off");
    }
}

void writeModel(const LevelSet& model, const std::vector<std::string>& paths,
                const ModelOutputOptions& options, OutputSet& outputs, const RunContext& ctx) {
    requireOutputPaths(paths);
    std::vector<std::string> temporaries;
    for (const std::string& path : paths) temporaries.push_back(outputs.add(path));
    std::optional<Mesh> mesh;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        Stage stage(ctx, "writing " + paths[i], 1);
        writeOne(model, paths[i], temporaries[i], options, mesh, ctx);
        stage.advance();
    }
}

}  // namespace vdbsynth
