#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/outputs.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

// --as says what to write where the extension may be several things; volume says what to take the input for.
void requireKind(const std::string& as, const std::string& extension) {
    const bool heights = extension == "png" || extension == "exr";
    if (as == "points") requireOption(extension == "ply", "as", as, "written to .ply");
    if (as == "levelset") requireOption(extension == "vdb", "as", as, "written to .vdb");
    if (as == "heightfield") requireOption(heights, "as", as, "written to .png or .exr");
    if (as == "mesh")
        requireOption(!heights && extension != "vdb", "as", as,
                      "written to .obj, .ply, .stl, .off, .glb or .gltf");
}

void convert(Run& run) {
    run.requireInputs(1, 1);
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    ModelOptions modelOptions = run.modelOptions();
    ModelOutputOptions outputs;
    outputs.plane = modelOptions.heights.plane;
    outputs.height = modelOptions.heights.height;
    const std::string as = run.arguments.text("as", "auto");
    const bool fromStream = !run.arguments.inputs.empty() && isKnownExtension(as);  // read by then
    requireOption(as == "auto" || as == "mesh" || as == "points" || as == "levelset" || as == "heightfield" ||
                      as == "volume" || fromStream,
                  "as", as,
                  "mesh, points, levelset, heightfield or volume; or an extension for standard input");
    outputs.points = as == "points";
    for (const std::string& path : paths) requireKind(as, extensionOf(path));
    modelOptions.carry = true;
    modelOptions.imageAsVolume = as == "volume";
    outputs.sharp = modelOptions.keepSource = modelOptions.solid.exact = run.arguments.has("sharp");
    if (outputs.sharp && run.arguments.has("adaptivity"))
        throw Error(ErrorCode::InvalidOption, "--sharp and --adaptivity: give one of them");
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
    {{"as", "KIND",
      "mesh, points, levelset or heightfield: what to write, default by extension (.ply: "
      "mesh); volume: what an image is; for standard input: its extension"},
     {"adaptivity", "A", "0 to 1: merge flat parts of a mesh, default 0"},
     {"sharp", "", "keep the edges and corners of a mesh, by the input's faces where it is a mesh"},
     {"spacing", "S", "least distance between points (voxels), default 1"}},
    convert};

}  // namespace vdbsynth::cli
