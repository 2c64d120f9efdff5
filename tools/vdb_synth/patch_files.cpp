#include "tools/vdb_synth/patch_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/patch/patch_map.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {

PatchSourceOptions patchSourceOptions(const Run& run) {
    PatchSourceOptions options;
    options.model = run.modelOptions();
    if (run.arguments.has("plane")) {
        const std::string plane = run.arguments.text("plane");
        options.plane = plane == "xy" ? PatchPlane::XY : plane == "yz" ? PatchPlane::YZ : PatchPlane::ZX;
    }
    if (run.arguments.has("margin")) options.margin = run.arguments.real("margin");
    validate(options);
    return options;
}

void countBorders(Run& run, const BorderStats& borders) {
    run.count("borders", {{"warped", borders.warps},
                          {"shrunk", borders.shrunk},
                          {"apart_before", borders.apartBefore},
                          {"apart_after", borders.apartAfter}});
}

void writeSheetModels(Run& run, const std::vector<std::string>& paths, const PatchSource& source,
                      const PatchSheet& sheet, const PointCloud& cloud) {
    const Arguments& arguments = run.arguments;
    const double voxelSize = arguments.has("voxel-size") ? arguments.real("voxel-size") : source.voxelSize;
    LevelSet model = sheetLevelSet(source, sheet, voxelSize, run.modelOptions().halfWidth, run.context);
    carryAttributes(cloud, model, run.context);
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity");
    outputs.metadata = run.metadata();
    writeModel(model, paths, outputs, run.outputs(), run.context);
    run.describe(model);
}

void writeSheet(Run& run, const PatchSource& source, const PatchSheet& sheet) {
    std::vector<std::string> models;
    for (const std::string& path : run.outputPaths()) {
        if (!takesPoints(path)) {
            models.push_back(path);
            continue;
        }
        const PointCloud cloud = sheetCloud(source, sheet);
        run.count("points", cloud.points.size());
        writePly(run.outputs().add(path), cloud, {});
    }
    if (!models.empty()) writeSheetModels(run, models, source, sheet, sheetCloud(source, sheet));
}

PatchSource loadRepeated(Run& run, const PatchBox& box, PatchPlane plane) {
    const std::vector<std::string>& inputs = run.arguments.inputs;
    if (inputs.size() != 2)
        throw Error(ErrorCode::ShapeMismatch, inputs[0] + ": repeat this map as: repeat MAP EXEMPLAR");
    requireOutputPaths(run.outputPaths());
    run.reserveOutputs();
    PatchSourceOptions options;
    options.model = run.modelOptions();
    options.plane = plane;
    options.box = box;
    PatchSource source = loadPatchSource(inputs[1], options, run.context);
    run.noteInput(inputs[1]);
    return source;
}

void repeatPatchMap(Run& run, const PatchMapFile& map) {
    const PatchSource source = loadRepeated(run, map.box, map.plane);
    const PatchSheet sheet = repeatPatchSheet(source, map, run.context);
    writeSheet(run, source, sheet);
    run.count("patches", sheet.result.patches);
    run.finish();
}

}  // namespace vdbsynth::cli
