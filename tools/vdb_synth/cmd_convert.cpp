#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/io/volume_file.h"
#include "libvdbsynth/pipeline/convert/outputs.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {
namespace {

// --as says what is written; volume also reads an image as a volume, which may then be written as anything.
void requireKind(const std::string& as, const std::string& input, const std::string& path) {
    const std::string extension = extensionOf(path);
    VolumeFormat format{};
    const bool volume = volumeFormatOf(path, format);
    const bool heights = extension == "png" || extension == "exr";
    const auto require = [&](bool good, const char* written) {
        if (!good) throw Error(ErrorCode::InvalidOption, "--as " + as + ": must be written to " + written);
    };
    if (as == "points") require(extension == "ply", ".ply");
    if (as == "levelset") require(extension == "vdb", ".vdb");
    if (as == "heightfield") require(heights, ".png or .exr");
    if (as == "volume")
        require(volume || isRasterPath(input),
                (std::string(kVolumeOutputs) + ", unless an image is read").c_str());
    if (as == "mesh")
        require(!heights && !volume && extension != "vdb", ".obj, .ply, .stl, .off, .glb, .gltf or .3mf");
}

// --height is of images, as inputs and as outputs; --spacing of points.
void noteUnused(const Run& run, const std::vector<std::string>& paths) {
    const auto isImage = [](const std::string& path) {
        return extensionOf(path) == "png" || extensionOf(path) == "exr";
    };
    if (run.arguments.has("height") && !isRasterPath(run.arguments.inputs[0]) &&
        std::none_of(paths.begin(), paths.end(), isImage))
        message(run.context, MessageLevel::Note, "`height` has no effect without an image to read or write");
    if (run.arguments.has("spacing") && run.arguments.text("as") != "points")
        message(run.context, MessageLevel::Note, "`spacing` has no effect without --as points");
}

void convert(Run& run) {
    run.requireInputs(1, 1);
    const std::vector<std::string> paths = run.outputPaths();
    ModelOptions modelOptions = run.modelOptions();
    ModelOutputOptions outputs;
    outputs.plane = modelOptions.heights.plane;
    outputs.height = modelOptions.heights.height;
    const std::string as = run.arguments.text("as");
    outputs.points = as == "points";
    for (const std::string& path : paths) requireKind(as, run.arguments.inputs[0], path);
    modelOptions.carry = true;
    modelOptions.imageAsVolume = as == "volume";
    outputs.sharp = modelOptions.keepSource = modelOptions.solid.exact = run.arguments.has("sharp");
    if (outputs.sharp && run.arguments.has("adaptivity"))
        throw Error(ErrorCode::InvalidOption, "--sharp and --adaptivity: give one of them");
    outputs.adaptivity = run.arguments.real("adaptivity");
    outputs.spacing = run.arguments.real("spacing");
    requireModelPath(run.arguments.inputs[0]);
    const LevelSet model =
        withHalfWidth(run.load(run.arguments.inputs[0], modelOptions), modelOptions.halfWidth, run.context);
    noteUnused(run, paths);
    run.describeOutputs(outputs);
    writeModel(model, paths, outputs, run.outputs(), run.context);
    run.describe(model);
    run.finish();
}

}  // namespace

const Command kConvert{"convert", "convert IN -o OUT [options]",
                       "Turn any model into a level set, mesh or points",
                       "vdb_synth convert bunny.off -o bunny.vdb --resolution 200", convert};

}  // namespace vdbsynth::cli
