#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/patch_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/patch/patch.h"
#include "libvdbsynth/pipeline/patch/patch_map.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {
namespace {

constexpr double kDraftStep = 2;  // times the usual step

void refuseOtherMethod(const Arguments& arguments) {
    const std::string method = arguments.text("method");
    const std::vector<const char*> others =
        method == "paper" ? std::vector<const char*>{"repairs", "tile", "draft"}
                          : std::vector<const char*>{"weight-normal",    "weight-variation", "weight-length",
                                                     "weight-direction", "limit-position",   "limit-normal",
                                                     "limit-variation",  "pairing-rounds",   "seed-patch"};
    for (const char* name : others)
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": has no effect with --method " + method);
}

// Given weights replace those found only all together: half of them would count in other units.
std::optional<PairingWeights> weightsOf(const Arguments& arguments) {
    const std::vector<const char*> names{"weight-normal", "weight-variation", "weight-length",
                                         "weight-direction"};
    const auto given =
        std::count_if(names.begin(), names.end(), [&](const char* name) { return arguments.has(name); });
    if (given == 0) return std::nullopt;
    for (const char* name : names)
        if (!arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": give all four weights, or none");
    return PairingWeights{1, arguments.real("weight-normal"), arguments.real("weight-variation"),
                          arguments.real("weight-length"), arguments.real("weight-direction")};
}

PatchOptions parseOptions(const Arguments& arguments) {
    refuseOtherMethod(arguments);
    PatchOptions options;
    options.method = arguments.text("method") == "paper" ? PatchMethod::Paper : PatchMethod::Default;
    options.patch = arguments.real("patch");
    options.overlap = arguments.real("overlap");
    options.tolerance = arguments.real("tolerance");
    options.step = arguments.real("field-step");
    options.tile = arguments.has("tile");
    options.repairs = arguments.whole("repairs");
    options.weights = weightsOf(arguments);
    options.limits = {arguments.real("limit-position"), arguments.real("limit-normal"),
                      arguments.real("limit-variation")};
    options.rounds = arguments.whole("pairing-rounds");
    if (arguments.has("seed-patch")) {
        const auto place = arguments.triple("seed-patch");
        options.seedPlace = Vec3d{place[0], place[1], place[2]};
    }
    if (arguments.has("draft")) {
        if (!arguments.has("repairs")) options.repairs = 0;
        options.warp = options.blend = false;
    }
    return options;
}

void setSize(const Arguments& arguments, const PatchExemplar& exemplar, PatchOptions& options) {
    const auto sizes = arguments.sheetSizes("size");
    options.width = sizes[0].multiple ? sizes[0].value * exemplar.size.x : sizes[0].value;
    options.depth = sizes[1].multiple ? sizes[1].value * exemplar.size.y : sizes[1].value;
}

void report(Run& run, const PatchSource& source, const PatchSheet& sheet) {
    const PatchResult& result = sheet.result;
    run.count("points_in", source.exemplar.points.size());
    run.count("points_out", result.sheet.size());
    run.count("patches", result.patches);
    run.count("spacing", source.exemplar.spacing);
    run.count("patch", result.patch);
    run.count("overlap", result.overlap);
    run.count(
        "seconds",
        {{"search", result.search}, {"warp", result.warp}, {"blend", result.blend}, {"other", result.other}});
    if (run.arguments.text("method") == "paper") {
        const PairingWeights& w = result.weights;
        run.count("pairs", result.pairs);
        run.count("unwarped", result.unwarped);
        run.count("weights", {{"normal", w.normal},
                              {"variation", w.variation},
                              {"length", w.length},
                              {"direction", w.direction}});
        if (result.unwarped > 0)
            message(run.context, MessageLevel::Note,
                    std::to_string(result.unwarped) + " of " + std::to_string(result.patches) +
                        " patches had fewer than four pairs and were not warped; a larger --limit-position "
                        "finds more");
    } else {
        countBorders(run, result.borders);
    }
    message(run.context, MessageLevel::Note,
            std::to_string(result.patches) + " patches " + roundedText(result.patch, 4) + " wide, " +
                std::to_string(result.sheet.size()) + " points; the sheet is " + roundedText(sheet.width, 6) +
                "," + roundedText(sheet.depth, 6) + " (world)");
}

void patch(Run& run) {
    const Arguments& arguments = run.arguments;
    if (arguments.has("hole") || arguments.has("keep")) return repairWithPatches(run);
    run.requireInputs(1, 1);
    if (arguments.has("onto")) return patchOntoModel(run);
    for (const char* name : {"direction", "scale", "height-offset", "with-model"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": has no effect without --onto");
    PatchOptions options = parseOptions(arguments);
    if (!arguments.has("size"))
        throw Error(ErrorCode::InvalidOption,
                    "--size: is missing; give the sheet's, for example --size 4x,4x, or --onto MODEL");
    const PatchSourceOptions sourceOptions = patchSourceOptions(run);
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    if (arguments.has("source-map") && options.method == PatchMethod::Paper)
        throw Error(
            ErrorCode::InvalidOption,
            "--source-map: has no effect with --method paper; the points' `source` says where each is from");
    requireModelPath(arguments.inputs[0]);
    run.reserveOutputs();
    const PatchSource source = loadPatchSource(arguments.inputs[0], sourceOptions, run.context);
    run.noteInput(arguments.inputs[0]);
    setSize(arguments, source.exemplar, options);
    if (arguments.has("draft") && !arguments.has("field-step"))
        options.step = kDraftStep * fieldStep(source.exemplar, options) / source.exemplar.spacing;
    const PatchSheet sheet = makePatchSheet(source, options, run.context);
    writeSheet(run, source, sheet);
    if (arguments.has("source-map"))
        writeVdb(run.outputs().add(arguments.text("source-map")), {patchMapGrid(source, sheet, options)},
                 run.metadata());
    report(run, source, sheet);
    run.finish();
}

}  // namespace

const Command kPatch{
    "patch",
    "patch EXEMPLAR -o OUT --size X,Y | --onto MODEL [options] | patch SHEET --hole MODEL|BOX -o OUT | patch "
    "EXEMPLAR --keep SHEET --hole MODEL|BOX -o OUT",
    "Make a larger sheet of a geometry texture, patch by patch, lay it over a model, or repair a sheet",
    "vdb_synth patch mail.ply --size 4x,4x -o sheet.ply -o sheet.vdb", patch};

}  // namespace vdbsynth::cli
