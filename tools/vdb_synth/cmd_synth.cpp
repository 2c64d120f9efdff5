#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/index_option.h"
#include "tools/vdb_synth/map_place.h"
#include "tools/vdb_synth/mask_option.h"
#include "tools/vdb_synth/world_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/fill/fill.h"
#include "libvdbsynth/pipeline/synth/synth.h"
#include "libvdbsynth/vdb/control_grids.h"

#include <nlohmann/json.hpp>

#include <cmath>

#include <optional>

namespace vdbsynth::cli {
namespace {

// Range and form were checked together with the other options.
void readSize(const Arguments& arguments, SynthOptions& options) {
    if (!arguments.has("size"))
        throw Error(ErrorCode::InvalidOption,
                    "--size: missing; give X,Y,Z in voxels or as multiples, for example --size 2x,2x,1x");
    const std::array<SizeValue, 3> sizes = arguments.sizes("size");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (sizes[axis].world) continue;  // withWorldSizes
        options.size[int(axis)] = sizes[axis].multiple ? Extent::multiple(sizes[axis].value)
                                                       : Extent::voxels(int(sizes[axis].value));
    }
}

// Lengths become voxels once the exemplar's are known.
void withWorldSizes(const Arguments& arguments, double voxelSize, SynthOptions& options) {
    const std::array<SizeValue, 3> sizes = arguments.sizes("size");
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!sizes[axis].world) continue;
        const double voxels = std::round(sizes[axis].value / voxelSize);
        if (!(voxels >= 1 && voxels <= 1 << 20))
            throw Error(ErrorCode::InvalidOption,
                        "--size " + arguments.text("size") + ": must be 1 to 1048576 voxels of " +
                            roundedText(voxelSize, 6) + " (world) along every axis");
        options.size[int(axis)] = Extent::voxels(int(voxels));
    }
}

void readBorder(const Arguments& arguments, SynthOptions& options) {
    if (!arguments.has("border")) return;
    const std::array<std::string, 3> words = splitAxisChoices(arguments.text("border"));
    for (std::size_t axis = 0; axis < 3; ++axis)
        options.border[axis] = words[axis] == "cut"      ? Border::Cut
                               : words[axis] == "object" ? Border::Object
                                                         : Border::Tile;
}

SynthesisMethod methodOf(const Arguments& arguments) {
    const std::string name = arguments.text("method");
    return name == "exact"   ? SynthesisMethod::Exact
           : name == "paper" ? SynthesisMethod::Paper
                             : SynthesisMethod::Default;
}

SynthOptions parseOptions(const Arguments& arguments) {
    SynthOptions options;
    readSize(arguments, options);
    readBorder(arguments, options);
    if (arguments.has("origin")) {
        const std::array<double, 3> origin = arguments.triple("origin");
        options.origin = Vec3d{origin[0], origin[1], origin[2]};
    }
    options.block = arguments.whole("block");
    options.levels = arguments.whole("levels");
    options.drift = arguments.whole("drift");
    options.draft = arguments.has("draft");
    options.carried = attributeValues(arguments);
    options.method = methodOf(arguments);
    options.indexCache = indexFolder(arguments);
    options.longestRun = arguments.real("longest-run");
    if (options.draft || options.method != SynthesisMethod::Default)
        for (const char* name : {"longest-run", "direction", "rotation-map", "scale-map", "exemplar-map"})
            if (arguments.has(name))
                throw Error(ErrorCode::InvalidOption,
                            std::string("--") + name + ": needs --method default and no --draft");
    options.halfWidth = float(arguments.real("half-width"));
    return options;
}

LevelSet holeOf(Run& run, const LevelSet& partial, const ModelOptions& like) {
    const std::string text = run.arguments.text("hole");
    BoxValue box;
    if (text == "auto") return holesAtOpenEdges(partial, run.context);
    if (readBox(text, box))
        return boxHole(partial, voxelsOf(box, transformOf(*partial.grid), "--hole " + text), run.context);
    ModelOptions options = like;
    options.grid.clear();
    return run.load(text, options);
}

// synth [EXEMPLAR] --keep PARTIAL --hole MODEL: fills missing geometry.
void fill(Run& run) {
    const Arguments& arguments = run.arguments;
    run.requireInputs(0, 1);
    for (const char* option : {"size",
                               "origin",
                               "border",
                               "exemplar-box",
                               "exemplar-mask",
                               "drift",
                               "draft",
                               "method",
                               "carry",
                               "carry-blend",
                               "exemplar-map",
                               "guide",
                               "exemplar-guide",
                               "guide-weight",
                               "longest-run",
                               "rotation-map",
                               "scale-map",
                               "direction",
                               "exemplar-direction",
                               "half-width",
                               "index-cache"})
        if (arguments.has(option))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + option + ": cannot be combined with --keep, which fills holes");
    if (!arguments.has("hole"))
        throw Error(ErrorCode::InvalidOption,
                    "--hole: missing; give a model whose inside is to be filled, a box i,j,k,I,J,K, or auto");
    const std::vector<std::string> paths = run.outputPaths();
    const MapPlace place = mapPlaceOf(arguments, paths);
    FillOptions options;
    options.block = arguments.whole("block");
    options.levels = arguments.whole("levels");
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity");
    const std::string partialPath = arguments.text("keep");
    ModelOptions modelOptions = run.modelOptions();
    modelOptions.halfWidth = 3;
    modelOptions.keepSource = arguments.text("hole") == "auto";
    modelOptions.carry = true;
    const LevelSet partial = run.load(partialPath, modelOptions);
    // The other models are loaded at the kept model's voxel size.
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

// Checks that need no file.
void requireControls(const Arguments& arguments) {
    if (arguments.has("exemplar-map") && arguments.inputs.size() < 2)
        throw Error(ErrorCode::InvalidOption, "--exemplar-map: chooses between exemplars; give at least two");
    if (arguments.has("direction") && arguments.has("rotation-map"))
        throw Error(ErrorCode::InvalidOption,
                    "--direction and --rotation-map: give one of them; both say how the exemplar is rotated");
    if (arguments.has("exemplar-direction") && !arguments.has("direction"))
        throw Error(ErrorCode::InvalidOption,
                    "--exemplar-direction: needs --direction, along which the exemplar is rotated");
    if (arguments.has("guide") != arguments.has("exemplar-guide"))
        throw Error(ErrorCode::InvalidOption,
                    "--guide and --exemplar-guide: give both, the same scalar over result and exemplar");
    if (!arguments.has("guide")) return;
    const std::size_t guides = arguments.all("exemplar-guide").size();
    if (guides != arguments.inputs.size())
        throw Error(ErrorCode::InvalidOption, "--exemplar-guide: given " + std::to_string(guides) +
                                                  " times; give it once for each exemplar, in their order");
}

// All exemplars are loaded at the first one's voxel size.
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

// Controls are grids; --exemplar-map may also be any model.
void loadControls(Run& run, double voxelSize, SynthOptions& options) {
    const Arguments& arguments = run.arguments;
    const std::string map = arguments.text("exemplar-map");
    if (namesGrid(map)) {
        options.exemplarMap = run.loadGrid("exemplar-map");
    } else if (!map.empty()) {
        ModelOptions model;
        model.voxelSize = voxelSize;
        options.exemplarMap = asControl(run.load(map, model).grid);
    }
    if (arguments.has("rotation-map")) options.rotationMap = run.loadGrid("rotation-map");
    if (arguments.has("direction")) options.direction = directionOf(run, "direction");
    if (arguments.has("exemplar-direction"))
        options.exemplarDirection = directionOf(run, "exemplar-direction");
    if (arguments.has("scale-map")) options.scaleMap = run.loadGrid("scale-map");
    if (!arguments.has("guide")) return;
    options.guide = run.loadGrid("guide");
    for (const std::string& path : arguments.all("exemplar-guide"))
        options.exemplarGuides.push_back(run.loadGrid("exemplar-guide", path));
    options.guideWeight = arguments.real("guide-weight");
}

void synth(Run& run) {
    if (run.arguments.has("keep")) return fill(run);
    if (run.arguments.has("hole"))
        throw Error(ErrorCode::InvalidOption, "--hole: needs --keep PARTIAL, the model that has the hole");
    run.requireInputs(1, 64);
    const std::vector<std::string> paths = run.outputPaths();
    SynthOptions options = parseOptions(run.arguments);
    requireControls(run.arguments);
    const MapPlace place = mapPlaceOf(run.arguments, paths);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity");
    for (const std::string& path : run.arguments.inputs) requireModelPath(path);
    ModelOptions modelOptions = run.modelOptions();
    modelOptions.halfWidth = 3;
    modelOptions.carry = true;
    std::vector<LevelSet> exemplars = loadExemplars(run, modelOptions);
    keepNamedAttributes(run.arguments, exemplars);
    const auto& first = *exemplars.front().grid;
    withWorldSizes(run.arguments, voxelSizeOf(first), options);
    if (run.arguments.has("exemplar-box"))
        options.exemplarBox = voxelsOf(run.arguments.box("exemplar-box"), transformOf(first),
                                       "--exemplar-box " + run.arguments.text("exemplar-box"));
    if (run.arguments.has("exemplar-mask"))
        options.exemplarMask = maskOf(run, "exemplar-mask", voxelSizeOf(first));
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
    "Synthesize more geometry that looks like an exemplar",
    "vdb_synth synth grid.vdb -o more.vdb --size 2x,2x,1x", synth};

}  // namespace vdbsynth::cli
