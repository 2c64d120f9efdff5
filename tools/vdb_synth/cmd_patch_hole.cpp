// patch SHEET --hole BOX|MODEL, and patch EXEMPLAR --keep SHEET --hole BOX|MODEL.
#include "tools/vdb_synth/option_value.h"
#include "tools/vdb_synth/patch_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/patch/patch_hole.h"

#include <nlohmann/json.hpp>

#include <array>
#include <optional>

namespace vdbsynth::cli {
namespace {

constexpr double kDraftStep = 2;  // times the usual step

void refuseOthers(const Arguments& arguments) {
    for (const char* name :
         {"size", "tile", "source-map", "onto", "direction", "scale", "height-offset", "with-model",
          "weight-normal", "weight-variation", "weight-length", "weight-direction", "limit-position",
          "limit-normal", "limit-variation", "pairing-rounds", "seed-patch"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": cannot be combined with --hole, which repairs a sheet");
    if (arguments.text("method") == "paper")
        throw Error(ErrorCode::InvalidOption, "--method paper: repairs no sheets; leave it out with --hole");
    if (!arguments.has("hole"))
        throw Error(ErrorCode::InvalidOption,
                    "--hole: missing; give a model whose inside is to be replaced, or a box x,y,z,X,Y,Z");
    if (!arguments.has("keep") && arguments.has("margin"))
        throw Error(ErrorCode::InvalidOption,
                    "--margin: has no effect on a sheet that is repaired; it is EXEMPLAR's, with --keep");
}

PatchOptions parseOptions(const Arguments& arguments) {
    PatchOptions options;
    options.width = options.depth = 1;
    options.patch = arguments.real("patch");
    options.overlap = arguments.real("overlap");
    options.tolerance = arguments.real("tolerance");
    options.step = arguments.real("field-step");
    options.repairs = arguments.whole("repairs");
    if (arguments.has("draft")) {
        if (!arguments.has("repairs")) options.repairs = 0;
        options.warp = options.blend = false;
    }
    validate(options);
    return options;
}

// A model is read like an exemplar of models; a sheet of points has no voxels.
std::vector<std::uint8_t> holeOf(Run& run, const PatchSource& sheet, double step) {
    const std::string text = run.arguments.text("hole");
    std::array<double, 6> box;
    if (readWorldBox(text, box))
        return holeColumns(sheet, PatchBox{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}}, step,
                           run.context);
    ModelOptions options = run.modelOptions();
    options.grid.clear();
    options.resolution = 0;
    options.voxelSize = step / 2;
    return holeColumns(sheet, run.load(text, options), step, run.context);
}

void writeRepaired(Run& run, const PatchSource& sheet, const RepairedSheet& repaired) {
    std::vector<std::string> models;
    for (const std::string& path : run.outputPaths()) {
        if (!takesPoints(path)) {
            models.push_back(path);
            continue;
        }
        run.count("points", repaired.cloud.points.size());
        writePly(run.outputs().add(path), repaired.cloud, {});
    }
    if (!models.empty()) writeSheetModels(run, models, sheet, repaired.sheet, repaired.cloud);
}

void report(Run& run, const PatchSource& sheet, const RepairedSheet& repaired) {
    const RepairResult& repair = repaired.repair;
    run.count("points_in", sheet.exemplar.points.size());
    run.count("points_kept", repair.kept.size());
    run.count("points_removed", repair.removed);
    run.count("points_out", repaired.cloud.points.size());
    run.count("patches", repair.patches);
    run.count("spacing", sheet.exemplar.spacing);
    run.count("patch", repair.patch);
    run.count("overlap", repair.overlap);
    run.count("seconds", {{"search", repair.search}, {"warp", repair.warp}, {"other", repair.other}});
    countBorders(run, repair.borders);
    message(run.context, MessageLevel::Note,
            std::to_string(repair.patches) + (repair.patches == 1 ? " patch " : " patches ") +
                roundedText(repair.patch, 4) + " wide in the hole; " + std::to_string(repair.kept.size()) +
                " of " + std::to_string(sheet.exemplar.points.size()) + " points stay as they are, " +
                std::to_string(repair.removed) + " lay in the hole");
}

}  // namespace

void repairWithPatches(Run& run) {
    const Arguments& arguments = run.arguments;
    const bool kept = arguments.has("keep");
    run.requireInputs(kept ? 0 : 1, 1);
    refuseOthers(arguments);
    PatchOptions options = parseOptions(arguments);
    PatchSourceOptions sourceOptions = patchSourceOptions(run);
    requireOutputPaths(run.outputPaths());
    const std::string path = kept ? arguments.text("keep") : arguments.inputs[0];
    requireModelPath(path);
    const bool other = kept && !arguments.inputs.empty();
    if (other) requireModelPath(arguments.inputs[0]);
    run.reserveOutputs();
    PatchSourceOptions whole = sourceOptions;
    whole.margin.reset();
    whole.whole = true;
    const PatchSource sheet = loadPatchSource(path, whole, run.context);
    run.noteInput(path);
    if (!sheet.isPoints)
        message(run.context, MessageLevel::Note,
                path +
                    ": is repaired as points half a voxel apart, so all of it is made anew; synth --keep "
                    "keeps voxels");
    if (arguments.has("draft") && !arguments.has("field-step"))
        options.step = kDraftStep * repairStep(sheet.exemplar, options) / sheet.exemplar.spacing;
    const auto hole = holeOf(run, sheet, repairStep(sheet.exemplar, options));
    std::optional<PatchSource> exemplar;
    if (other) {
        sourceOptions.plane = sheet.exemplar.plane;
        exemplar = loadPatchSource(arguments.inputs[0], sourceOptions, run.context);
        run.noteInput(arguments.inputs[0]);
    }
    const RepairedSheet repaired =
        repairSheet(sheet, hole, exemplar ? &*exemplar : nullptr, options, run.context);
    writeRepaired(run, sheet, repaired);
    report(run, sheet, repaired);
    run.finish();
}

}  // namespace vdbsynth::cli
