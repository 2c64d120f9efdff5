#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/index_option.h"
#include "tools/vdb_synth/map_place.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/control.h"
#include "libvdbsynth/pipeline/fill.h"
#include "libvdbsynth/pipeline/outputs.h"
#include "libvdbsynth/pipeline/synth.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

namespace vdbsynth::cli {
namespace {

void parseSize(const Arguments& arguments, SynthOptions& options) {
    const std::string text = arguments.text("size");
    if (text.empty())
        throw Error(ErrorCode::InvalidOption,
                    "--size: missing; give X,Y,Z in voxels or as multiples, for example --size 2x,2x,1x");
    const std::vector<std::string> parts = splitAtCommas(text);
    const char* range =
        "three sizes with commas, each in voxels or as a multiple, for example 2x,2x,1x or 128,128,64";
    requireOption(parts.size() == 3, "size", text, range);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        char* end = nullptr;
        const double value = std::strtod(parts[axis].c_str(), &end);
        const bool multiple = std::string(end) == "x";
        requireOption(!parts[axis].empty() && end != parts[axis].c_str() && (multiple || *end == 0) &&
                          std::isfinite(value) && value > 0,
                      "size", text, range);
        requireOption(multiple ? value >= 1 && value <= 1e6 : value == std::floor(value) && value <= 1 << 20,
                      "size", text,
                      multiple ? "multiples of at least 1x" : "whole numbers of voxels up to 1048576");
        options.size[int(axis)] = multiple ? Extent::multiple(value) : Extent::voxels(int(value));
    }
    arguments.note("size", options.size.text());
}

void parseBorder(const Arguments& arguments, SynthOptions& options) {
    const std::string text = arguments.text("border");
    if (text.empty()) return;
    std::vector<std::string> parts = splitAtCommas(text);
    if (parts.size() == 1) parts.assign(3, parts[0]);
    const char* range = "cut, object or tile, once or for each axis with commas";
    requireOption(parts.size() == 3, "border", text, range);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string& part = parts[axis];
        requireOption(part == "cut" || part == "object" || part == "tile", "border", text, range);
        options.border[axis] = part == "cut" ? Border::Cut : part == "object" ? Border::Object : Border::Tile;
    }
}

SynthesisMethod parseMethod(const Arguments& arguments) {
    if (!arguments.has("method")) return SynthesisMethod::Default;
    const std::string text = arguments.text("method");
    requireOption(text == "default" || text == "exact" || text == "paper", "method", text,
                  "default, exact or paper");
    return text == "default" ? SynthesisMethod::Default
           : text == "exact" ? SynthesisMethod::Exact
                             : SynthesisMethod::Paper;
}

SynthOptions parseOptions(const Arguments& arguments) {
    SynthOptions options;
    parseSize(arguments, options);
    parseBorder(arguments, options);
    if (arguments.has("exemplar-box")) options.exemplarBox = arguments.box("exemplar-box");
    options.block = arguments.whole("block", 0, 4, 256);
    options.levels = arguments.whole("levels", 0, 1, 8);
    options.drift = arguments.whole("drift", 0, 0, 1 << 20);
    options.draft = arguments.has("draft");
    options.carried = carriedValues(arguments);
    options.method = parseMethod(arguments);
    options.indexCache = indexFolder(arguments);
    options.longestRun = arguments.real("longest-run", 0.3, 0.01, 1);
    if (arguments.has("longest-run") && (options.draft || options.method != SynthesisMethod::Default))
        throw Error(ErrorCode::InvalidOption, "--longest-run: needs --method default and no --draft");
    options.halfWidth = float(arguments.real("half-width", 3, 1.5, 100));
    return options;
}

LevelSet holeOf(Run& run, const LevelSet& partial, const ModelOptions& like) {
    const std::string text = run.arguments.text("hole");
    IndexBox box;
    if (text == "auto") return holesAtOpenEdges(partial, run.context);
    if (parseBox(text, box)) return boxHole(partial, box, run.context);
    requireModelPath(text);
    ModelOptions options = like;
    options.grid.clear();
    return run.load(text, options);
}

// synth [EXEMPLAR] --keep PARTIAL --hole MODEL: more geometry where some is missing.
void fill(Run& run) {
    const Arguments& arguments = run.arguments;
    run.requireInputs(0, 1);
    for (const char* option : {"size", "border", "exemplar-box", "exemplar-mask", "drift", "draft", "method",
                               "carry", "carry-blend", "which", "guide", "exemplar-guide", "guide-weight",
                               "longest-run", "rotation-map", "scale-map"})
        if (arguments.has(option))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + option + ": has no meaning with --keep, which fills holes");
    if (!arguments.has("hole"))
        throw Error(ErrorCode::InvalidOption,
                    "--hole: missing; give a model whose inside is to be filled, a box i,j,k,I,J,K, or auto");
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    const MapPlace place = mapPlaceOf(arguments, paths);
    FillOptions options;
    options.block = arguments.whole("block", 0, 4, 256);
    options.levels = arguments.whole("levels", 0, 1, 8);
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity", 0, 0, 1);
    const std::string partialPath = arguments.text("keep");
    requireModelPath(partialPath);
    ModelOptions modelOptions = run.modelOptions();
    modelOptions.halfWidth = 3;
    modelOptions.keepSource = arguments.text("hole") == "auto";
    modelOptions.carry = true;
    const LevelSet partial = run.load(partialPath, modelOptions);
    // All else is made in the voxels of what is kept.
    modelOptions.voxelSize = voxelSizeOf(*partial.grid);
    modelOptions.resolution = 0;
    modelOptions.keepSource = false;
    modelOptions.carry = false;
    const LevelSet hole = holeOf(run, partial, modelOptions);
    modelOptions.carry = true;
    std::optional<LevelSet> exemplar;
    if (!arguments.inputs.empty()) {
        requireModelPath(arguments.inputs[0]);
        exemplar = run.load(arguments.inputs[0], modelOptions);
    }
    const FillResult result = fillHoles(partial, hole, exemplar ? &*exemplar : nullptr, options, run.context);
    writeWithMap(run, result.model, result.map, place, paths, outputs);
    run.count("block", result.stats.block);
    run.count("levels", result.stats.levels);
    run.count("matches", result.stats.matches);
    run.count("costs_computed", result.stats.exact);
    run.count("mean_match_cost", result.stats.meanCost);
    run.describe(result.model);
    run.finish();
}

// What needs no file.
void requireControls(const Arguments& arguments) {
    if (arguments.has("which") && arguments.inputs.size() < 2)
        throw Error(ErrorCode::InvalidOption,
                    "--which: says which of several exemplars goes where; give at least two");
    if (arguments.has("guide") != arguments.has("exemplar-guide"))
        throw Error(
            ErrorCode::InvalidOption,
            "--guide and --exemplar-guide: belong together, the same scalar over result and exemplar");
    if (!arguments.has("guide")) return;
    const std::size_t guides = arguments.all("exemplar-guide").size();
    requireOption(guides == arguments.inputs.size(), "exemplar-guide", std::to_string(guides) + " times",
                  "once for each exemplar, in their order");
}

// The first one's voxel size holds for all.
std::vector<LevelSet> loadExemplars(Run& run, ModelOptions options) {
    std::vector<LevelSet> exemplars;
    for (const std::string& path : run.arguments.inputs) {
        exemplars.push_back(run.load(path, options));
        options.voxelSize = voxelSizeOf(*exemplars.front().grid);
        options.resolution = 0;
    }
    return exemplars;
}

std::vector<const LevelSet*> pointersTo(const std::vector<LevelSet>& models) {
    std::vector<const LevelSet*> pointers;
    for (const LevelSet& model : models) pointers.push_back(&model);
    return pointers;
}

// Grids as they are; of --which also any model.
void loadControls(Run& run, double voxelSize, SynthOptions& options) {
    const Arguments& arguments = run.arguments;
    const std::string which = arguments.text("which");
    if (extensionOf(which) == "vdb" || which.find(".vdb:") != std::string::npos) {
        options.exemplarMap = run.loadMask("which");
    } else if (arguments.has("which")) {
        requireModelPath(which);
        ModelOptions model;
        model.voxelSize = voxelSize;
        options.exemplarMap = asControl(run.load(which, model).grid);
    }
    if (arguments.has("rotation-map")) options.rotationMap = run.loadMask("rotation-map");
    if (arguments.has("scale-map")) options.scaleMap = run.loadMask("scale-map");
    if (!arguments.has("guide")) return;
    options.guide = run.loadMask("guide");
    for (const std::string& path : arguments.all("exemplar-guide"))
        options.exemplarGuides.push_back(run.loadGrid("exemplar-guide", path));
    options.guideWeight = arguments.real("guide-weight", 4, 0.001, 1000);
}

void synth(Run& run) {
    if (run.arguments.has("keep")) return fill(run);
    if (run.arguments.has("hole"))
        throw Error(ErrorCode::InvalidOption, "--hole: needs --keep PARTIAL, the model that has the hole");
    run.requireInputs(1, 64);
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    SynthOptions options = parseOptions(run.arguments);
    requireControls(run.arguments);
    const MapPlace place = mapPlaceOf(run.arguments, paths);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity", 0, 0, 1);
    for (const std::string& path : run.arguments.inputs) requireModelPath(path);
    ModelOptions modelOptions = run.modelOptions();
    modelOptions.halfWidth = 3;
    modelOptions.carry = true;
    std::vector<LevelSet> exemplars = loadExemplars(run, modelOptions);
    keepCarried(run.arguments, exemplars);
    if (run.arguments.has("exemplar-mask")) options.exemplarMask = run.loadMask("exemplar-mask");
    loadControls(run, voxelSizeOf(*exemplars.front().grid), options);
    const SynthResult result = synthesize(pointersTo(exemplars), options, run.context);
    writeWithMap(run, result.model, result.map, place, paths, outputs);
    run.count("block", result.stats.block);
    run.count("levels", result.stats.levels);
    run.count("matches", result.stats.matches);
    run.count("costs_computed", result.stats.exact);
    if (options.method != SynthesisMethod::Default) {
        run.count("bounds_computed", result.stats.nodes);
        run.count("index_bytes", result.stats.indexBytes);
    }
    run.count("mean_match_cost", result.stats.meanCost);
    run.describe(result.model);
    run.finish();
}

}  // namespace

const Command kSynth{
    "synth",
    "synth EXEMPLAR... -o OUT --size X,Y,Z [options] | synth [EXEMPLAR] --keep PARTIAL --hole MODEL -o OUT",
    "Make more geometry like an exemplar's",
    "vdb_synth synth grid.vdb -o more.vdb --size 2x,2x,1x",
    {{"size", "X,Y,Z", "size of the result: voxels, or multiples of the exemplar's domain such as 2x,2x,1x"},
     {"block", "N", "side of the matched blocks (voxels), 4 to 256; default from the exemplar, at most 16"},
     {"levels", "N",
      "number of passes, coarse to fine; default 3, more for larger exemplars, or as many as fit"},
     {"method", "NAME",
      "default; exact: blocks in raster order, each the exact best match; paper: as published in 2004"},
     {"draft", "", "a quick look: blocks are searched at half the resolution, distances are approximate"},
     {"border", "KIND",
      "cut, object or tile (the result repeats without a seam), once or for each axis; default cut where a "
      "domain "
      "is recorded"},
     {"exemplar-box", "BOX",
      "domain i,j,k,I,J,K in the exemplar's index space, both corners inclusive (voxels)"},
     {"exemplar-mask", "FILE.vdb[:GRID]",
      "take blocks only from where this grid is active; its box is the domain (of the first exemplar)"},
     {"drift", "D", "how far sources may be from their own place along axes at 1x (voxels), default 0"},
     {"longest-run", "S",
      "share of the exemplar that may be copied in one piece, 0.01 to 1, default 0.3; less is newer and has "
      "more joints"},
     {"which", "FILE",
      "with several exemplars: which one goes where in the result; a .vdb with a grid of numbers (0 is the "
      "first) or any model, inside which the second is used, outside it the first"},
     {"guide", "FILE.vdb[:GRID]",
      "a grid of scalars over the result: parts of the exemplar are placed where --exemplar-guide has the "
      "like"},
     {"exemplar-guide", "FILE.vdb[:GRID]", "the same scalar over the exemplar; once for each exemplar", true},
     {"guide-weight", "W", "how much a guide counts beside the shape, 0.001 to 1000, default 4"},
     {"rotation-map", "FILE.vdb[:GRID]",
      "a grid over the result: by how much to turn what is copied, rotation vectors or angles about z "
      "(radians)"},
     {"scale-map", "FILE.vdb[:GRID]",
      "a grid over the result: by how much to scale what is copied, 0.25 to 4"},
     {"keep", "PARTIAL",
      "fill the holes of this model instead; the exemplar is then optional, default the model itself"},
     {"hole", "MODEL",
      "what to fill with --keep: the inside of a model, a box i,j,k,I,J,K of the kept model's voxels, or "
      "auto: a ball round each loop of open edges"},
     mapOption(),
     indexCacheOption(),
     carryOptions()[0],
     carryOptions()[1],
     {"adaptivity", "A", "0 to 1: merge flat parts of a mesh output, default 0"}},
    synth};

}  // namespace vdbsynth::cli
