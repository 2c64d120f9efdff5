// patch EXEMPLAR --onto MODEL.
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/patch_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/patch/patch_onto_map.h"
#include "libvdbsynth/pipeline/patch/patch_outputs.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {
namespace {

constexpr double kDraftStep = 2;  // times the usual step

void refuseSheets(const Arguments& arguments) {
    for (const char* name : {"size", "tile"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption, std::string("--") + name + ": has no effect with --onto");
    if (arguments.text("method") == "paper")
        throw Error(ErrorCode::InvalidOption, "--method paper: makes sheets only; leave it out with --onto");
    for (const char* name :
         {"weight-normal", "weight-variation", "weight-length", "weight-direction", "limit-position",
          "limit-normal", "limit-variation", "pairing-rounds", "seed-patch"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption, std::string("--") + name + ": has no effect with --onto");
}

PatchOntoOptions parseOptions(Run& run) {
    const Arguments& arguments = run.arguments;
    PatchOntoOptions options;
    options.onto.patch = arguments.real("patch");
    options.onto.overlap = arguments.real("overlap");
    options.onto.tolerance = arguments.real("tolerance");
    options.onto.step = arguments.real("field-step");
    options.onto.repairs = arguments.whole("repairs");
    options.onto.scale = arguments.real("scale");
    options.onto.heightOffset = arguments.real("height-offset");
    if (arguments.has("draft")) {
        if (!arguments.has("repairs")) options.onto.repairs = 0;
        options.onto.warp = options.onto.blend = false;
    }
    if (arguments.has("direction")) options.direction = directionOf(run, "direction");
    validate(options);
    return options;
}

std::vector<std::string> modelPaths(const Run& run) {
    std::vector<std::string> models = run.outputPaths();
    models.erase(std::remove_if(models.begin(), models.end(), takesPoints), models.end());
    return models;
}

void writePatched(Run& run, const PatchSource& source, const LevelSet* model, double scale,
                  const PatchedModel& patched) {
    const Arguments& arguments = run.arguments;
    for (const std::string& path : run.outputPaths()) {
        if (!takesPoints(path)) continue;
        const PointCloud cloud = ontoCloud(source, patched);
        run.count("points", cloud.points.size());
        writePly(run.outputs().add(path), cloud, {});
    }
    const std::vector<std::string> models = modelPaths(run);
    if (models.empty()) return;
    const double voxelSize =
        arguments.has("voxel-size") ? arguments.real("voxel-size") : source.voxelSize * scale;
    LevelSet made = ontoLevelSet(patched, voxelSize, run.modelOptions().halfWidth, model, run.context);
    carryAttributes(ontoCloud(source, patched), made, run.context);
    if (model && !source.attributes.empty())
        message(run.context, MessageLevel::Note,
                models.front() + ": MODEL's own surface takes " + source.attributes.front().name +
                    (source.attributes.size() > 1 ? " and others" : "") +
                    " of the points nearest to it; without --with-model there is none of it");
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity");
    run.describeOutputs(outputs);
    writeModel(made, models, outputs, run.outputs(), run.context);
    run.describe(made);
}

void report(Run& run, const PatchSource& source, const PatchedModel& patched) {
    const OntoResult& result = patched.result;
    run.count("points_in", source.exemplar.points.size());
    run.count("points_out", result.sheet.size());
    run.count("patches", result.patches);
    run.count("spacing", patched.exemplar.spacing);
    run.count("patch", result.patch);
    run.count("overlap", result.overlap);
    run.count("seconds", {{"search", result.search}, {"warp", result.warp}, {"other", result.other}});
    countBorders(run, result.borders);
    run.count("bend", {{"folded_share", result.bend.folded},
                       {"most", result.bend.most},
                       {"dropped", result.bend.dropped},
                       {"bare_sites", result.bend.bare}});
    message(run.context, MessageLevel::Note,
            std::to_string(result.patches) + " patches " + roundedText(result.patch, 4) + " wide, " +
                std::to_string(result.sheet.size()) + " points");
}

}  // namespace

void patchOntoModel(Run& run) {
    const Arguments& arguments = run.arguments;
    refuseSheets(arguments);
    const PatchSourceOptions sourceOptions = patchSourceOptions(run);
    requireOutputPaths(run.outputPaths());
    if (arguments.has("with-model") && modelPaths(run).empty())
        throw Error(ErrorCode::InvalidOption,
                    "--with-model: has no effect on .ply, which holds points; give a .vdb or a mesh too");
    requireModelPath(arguments.inputs[0]);
    run.reserveOutputs();
    PatchOntoOptions options = parseOptions(run);
    const PatchSource source = loadPatchSource(arguments.inputs[0], sourceOptions, run.context);
    run.noteInput(arguments.inputs[0]);
    if (arguments.has("draft") && !arguments.has("field-step")) {
        PatchOptions sheet;
        options.onto.step = kDraftStep * fieldStep(source.exemplar, sheet) / source.exemplar.spacing;
    }
    const LevelSet model = loadOntoModel(arguments.text("onto"), source, options, run.context);
    run.noteInput(arguments.text("onto"));
    const PatchedModel patched = patchOnto(source, model, options, run.context);
    writePatched(run, source, arguments.has("with-model") ? &model : nullptr, options.onto.scale, patched);
    if (arguments.has("source-map"))
        writeVdb(run.outputs().add(arguments.text("source-map")), patchOntoMapGrids(source, patched, options),
                 run.metadata());
    report(run, source, patched);
    run.finish();
}

void repeatPatchOntoMap(Run& run, const PatchOntoMapFile& map) {
    const PatchSource source = loadRepeated(run, map.box, map.plane);
    const PatchedModel patched = repeatPatchOnto(source, map, run.context);
    writePatched(run, source, nullptr, map.options.scale, patched);
    run.count("patches", patched.result.patches);
    run.finish();
}

}  // namespace vdbsynth::cli
