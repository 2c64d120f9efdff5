#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/outputs.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

void convert(Run& run) {
    run.requireInputs(1, 1);
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    const ModelOptions modelOptions = run.modelOptions();
    ModelOutputOptions outputs;
    const std::string as = run.arguments.text("as", "auto");
    requireOption(as == "auto" || as == "mesh" || as == "points" || as == "levelset", "as", as,
                  "mesh, points or levelset");
    outputs.points = as == "points";
    for (const std::string& path : paths) {
        const std::string extension = extensionOf(path);
        const bool fits = as == "auto" || (as == "levelset") == (extension == "vdb");
        requireOption(fits && (as != "points" || extension == "ply"), "as", as,
                      as == "points"     ? "written to .ply"
                      : as == "levelset" ? "written to .vdb"
                                         : "written to .obj, .ply, .stl or .off");
    }
    outputs.adaptivity = run.arguments.real("adaptivity", 0, 0, 1);
    outputs.spacing = run.arguments.real("spacing", 1, 0.25, 100);
    requireModelPath(run.arguments.inputs[0]);
    const LevelSet model =
        withHalfWidth(run.load(run.arguments.inputs[0], modelOptions), modelOptions.halfWidth, run.context);
    outputs.metadata = run.metadata();
    writeModel(model, paths, outputs, run.outputs(), run.context);
    run.describe(model);
    run.finish();
}

}  // namespace

const Command kConvert{
    "convert",
    "convert IN -o OUT [options]",
    "Turn any model into a level set, mesh or points",
    "vdb_synth convert bunny.off -o bunny.vdb --resolution 200",
    {{"as", "KIND", "mesh, points or levelset; default by the output's extension (.ply: mesh)"},
     {"adaptivity", "A", "0 to 1: merge flat parts of a mesh, default 0"},
     {"spacing", "S", "least distance between points (voxels), default 1"}},
    convert};

}  // namespace vdbsynth::cli
