#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/map_place.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/analogy.h"
#include "libvdbsynth/pipeline/control.h"
#include "libvdbsynth/pipeline/filter_analogy.h"
#include "libvdbsynth/pipeline/outputs.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

// An odd number of samples a side, as half of it.
int halfOf(const Arguments& arguments, const std::string& name, int fallback, int most) {
    const int side = arguments.whole(name, 2 * fallback + 1, 3, 2 * most + 1);
    requireOption(side % 2 == 1, name, std::to_string(side),
                  "an odd number from 3 to " + std::to_string(2 * most + 1));
    return side / 2;
}

AnalogyOptions parseOptions(const Arguments& arguments) {
    AnalogyOptions options;
    VolumeAnalogyOptions& synthesis = options.synthesis;
    synthesis.levels = arguments.whole("levels", 0, 1, 6);
    synthesis.sweeps = arguments.whole("sweeps", 2, 0, 10);
    synthesis.half = halfOf(arguments, "samples", 2, 4);
    synthesis.coarseHalf = halfOf(arguments, "coarse-samples", 1, 3);
    synthesis.components = arguments.whole("components", 16, 4, 256);
    synthesis.coherence = arguments.real("coherence", 0.5, 0, 100);
    if (arguments.has("exact")) synthesis.slack = 0;
    synthesis.causal = arguments.has("causal");
    synthesis.bent = !arguments.has("straight");
    synthesis.aligned = !arguments.has("naive");
    options.scale = arguments.real("scale", 1, 0.25, 4);
    options.strength = arguments.real("strength", 1, 0, 1);
    options.halfWidth = float(arguments.real("half-width", 3, 1.5, 100));
    options.keepDirections = arguments.has("write-directions");
    for (const char* name : {"direction", "exemplar-direction"}) {
        requireDirection(arguments, name);
        if (arguments.has(name) && arguments.has("naive"))
            throw Error(
                ErrorCode::InvalidOption,
                std::string("--") + name + ": --naive works along the grid's axes and takes no direction");
    }
    return options;
}

// A, A2, C, C2, ..., B. The first voxel size of a pair holds for both; the target has its own.
struct Models {
    std::vector<LevelSet> pairs;
    LevelSet target;
};

Models loadModels(Run& run) {
    const std::vector<std::string>& inputs = run.arguments.inputs;
    for (const std::string& path : inputs) requireModelPath(path);
    Models models;
    ModelOptions options = run.modelOptions();
    options.halfWidth = 3;
    ModelOptions pair = options;
    // --voxel-size and --resolution are the target's where it is a mesh; a pair has its own.
    pair.voxelSize = 0;
    pair.resolution = run.arguments.whole("exemplar-resolution", 0, 2, 100000);
    pair.grid.clear();
    pair.carry = true;
    for (std::size_t i = 0; i + 1 < inputs.size(); i += 2) {
        ModelOptions own = pair;
        models.pairs.push_back(run.load(inputs[i], own));
        const double voxelSize = voxelSizeOf(*models.pairs.back().grid);
        own.voxelSize = extensionOf(inputs[i + 1]) == "vdb" ? 0 : voxelSize;
        own.resolution = 0;
        models.pairs.push_back(run.load(inputs[i + 1], own));
    }
    models.target = run.load(inputs.back(), options);
    return models;
}

void loadMask(Run& run, double voxelSize, AnalogyOptions& options) {
    if (!run.arguments.has("mask")) return;
    const std::string text = run.arguments.text("mask");
    if (extensionOf(text) == "vdb" || text.find(".vdb:") != std::string::npos) {
        options.mask = run.loadMask("mask");
        return;
    }
    requireModelPath(text);
    ModelOptions model;
    model.voxelSize = voxelSize;
    model.halfWidth = 6;
    options.mask = asControl(run.load(text, model).grid);
}

void report(Run& run, const AnalogyResult& result) {
    nlohmann::json levels = nlohmann::json::array();
    for (const AnalogyLevelStats& level : result.levels)
        levels.push_back({{"voxels", level.voxels},
                          {"waves", level.waves},
                          {"features", level.features},
                          {"components", level.components},
                          {"variance_explained", level.explained},
                          {"coherent_share", level.coherent},
                          {"feature_distance", level.meanDistance},
                          {"feature_distance_exact", level.exactDistance}});
    run.count("levels", levels);
    run.count("texture_reach_voxels", result.reach);
    run.count("singularities", result.singularities.size());
    run.count("sweep_cut_share", result.cut);
    nlohmann::json places = nlohmann::json::array();
    for (const Vec3d& p : result.singularities) places.push_back({p.x, p.y, p.z});
    run.count("singularity_places", places);
    message(run.context, MessageLevel::Note,
            "the direction field has " + std::to_string(result.singularities.size()) +
                " singularities; near them a texture has no direction");
    run.describe(result.model);
}

FloatGridPtr loadNumbers(Run& run, const std::string& path, const std::string& grid) {
    run.reserveOutputs();
    const FloatGridPtr numbers = readVdbFloatGrid(path, grid, run.context);
    run.noteInput(path);
    if (!isGridOfNumbers(numbers))
        throw Error(ErrorCode::Unusable, path +
                                             ": is a level set, but the first input is a grid of numbers; "
                                             "give --iso to make a level set of that, or numbers for all");
    return numbers;
}

// --naive on grids of numbers: nothing is made a level set.
bool isFilter(Run& run) {
    const Arguments& arguments = run.arguments;
    if (!arguments.has("naive") || arguments.has("iso") || extensionOf(arguments.inputs[0]) != "vdb")
        return false;
    return isGridOfNumbers(readVdbFloatGrid(arguments.inputs[0], "", run.context));
}

void reportFilter(Run& run, const FilterAnalogyStats& stats) {
    run.count("rows", stats.rows);
    run.count("change", stats.change);
    run.count("affine_error", stats.affineError);
    run.count("search_error", stats.searchError);
    run.count("searched", stats.searched);
    if (stats.change > 0)
        message(run.context, MessageLevel::Note,
                "on voxels held out the filter is off by " +
                    std::to_string(std::min(stats.affineError, stats.searchError) / stats.change) +
                    " of what it changes (root mean squares)");
}

void filter(Run& run, const VolumeAnalogyOptions& synthesis) {
    const Arguments& arguments = run.arguments;
    for (const char* name : {"scale", "strength", "mask", "carry", "source-map", "write-directions", "causal",
                             "straight", "sweeps", "coherence", "coarse-samples", "adaptivity"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        "--" + std::string(name) + ": has no meaning for grids of numbers with --naive");
    FilterAnalogyOptions options;
    options.half = synthesis.half;
    options.components = synthesis.components;
    if (synthesis.levels > 0) options.levels = std::min(synthesis.levels, 4);
    for (const std::string& path : run.outputPaths())
        if (extensionOf(path) != "vdb")
            throw Error(ErrorCode::InvalidOption, path + ": grids of numbers are written as .vdb");
    std::vector<FilterGridPair> pairs;
    for (std::size_t i = 0; i + 1 < arguments.inputs.size(); i += 2) {
        const FloatGridPtr before = loadNumbers(run, arguments.inputs[i], "");
        pairs.push_back({before, loadNumbers(run, arguments.inputs[i + 1], "")});
    }
    const FloatGridPtr target = loadNumbers(run, arguments.inputs.back(), arguments.text("grid"));
    const FilterGridResult result = makeFilteredGrid(pairs, target, options, run.context);
    for (const std::string& path : run.outputPaths())
        writeVdb(run.outputs().add(path), {result.grid}, run.metadata());
    reportFilter(run, result.stats);
    run.finish();
}

void analogy(Run& run) {
    const Arguments& arguments = run.arguments;
    run.requireInputs(3, 33);
    if (arguments.inputs.size() % 2 == 0)
        throw Error(
            ErrorCode::InvalidOption,
            "an even number of inputs; give pairs, each plain then textured, and the target last; usage: "
            "vdb_synth " +
                std::string(kAnalogy.usage));
    AnalogyOptions options = parseOptions(arguments);
    const std::vector<std::string> paths = run.outputPaths();
    requireOutputPaths(paths);
    if (isFilter(run)) {
        filter(run, options.synthesis);
        return;
    }
    const MapPlace place = mapPlaceOf(arguments, paths);
    if (options.keepDirections && !anyVdb(paths))
        throw Error(ErrorCode::InvalidOption,
                    "--write-directions: goes into a .vdb output, and there is none");
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity", 0, 0, 1);
    Models models = loadModels(run);
    keepCarried(arguments, models.pairs);
    loadMask(run, voxelSizeOf(*models.target.grid), options);
    options.direction = directionOf(run, "direction");
    options.exemplarDirection = directionOf(run, "exemplar-direction");
    std::vector<AnalogyModelPair> pairs;
    for (std::size_t i = 0; i < models.pairs.size(); i += 2)
        pairs.push_back({&models.pairs[i], &models.pairs[i + 1]});
    const AnalogyResult result = makeAnalogyModel(pairs, models.target, options, run.context);
    if (result.directions) outputs.extraGrids.push_back(result.directions);
    writeWithMap(run, result.model, result.map, place, paths, outputs);
    report(run, result);
    run.finish();
}

}  // namespace

const Command kAnalogy{
    "analogy",
    "analogy A A2 [C C2 ...] B -o OUT [options]",
    "Put the texture that A2 has and A has not on another model B",
    "vdb_synth analogy A.vdb A2.vdb bunny.off --resolution 200 --direction axis:z -o grooved.vdb",
    {{"direction", "SPEC",
      "which way the texture runs over B: axis:x, axis:-z, around:y, radial, curvature (default), a grid of "
      "vectors or scalars FILE.vdb[:NAME], or strokes: .csv rows x,y,z,dx,dy,dz, .json, .ply points with "
      "normals (world)"},
     {"exemplar-direction", "SPEC", "the same over A; default what make wrote into A, else curvature"},
     {"exemplar-resolution", "N",
      "voxels along the longest side of a mesh A, default 128; A2 has A's voxels"},
     {"scale", "S", "of the texture: 2 is twice as large in B's voxels, 0.25 to 4, default 1"},
     {"strength", "T", "0 to 1: how far B becomes the result, default 1"},
     {"mask", "FILE", "where: a grid of values from 0 to 1, or any model, inside which the texture goes"},
     {"levels", "N", "levels of the pyramid, 1 to 6; default as many, at most 3, as still hold the texture"},
     {"sweeps", "N", "over every level, 1 to 10, default 2"},
     {"samples", "N", "side of a neighbourhood in samples, one a voxel: 3, 5 (default), 7 or 9"},
     {"coarse-samples", "N", "the same at the next coarser level: 3 (default), 5 or 7"},
     {"components", "N", "numbers that a neighbourhood is reduced to, 4 to 256, default 16"},
     {"coherence", "K", "how much going on from a neighbour counts over the best match, default 0.5"},
     {"exact", "", "the best match exactly, among reduced features (slower)"},
     {"causal", "", "of what is made only what lies behind a voxel counts, as in the paper"},
     {"straight", "",
      "neighbourhoods are straight cubes, as in the paper, and do not bend along the surface"},
     {"naive", "",
      "neighbourhoods along the grid's axes, as the paper's first variant: for blur and the like; three "
      "grids "
      "of numbers (fog volumes, scalars) stay numbers"},
     {"write-directions", "", "also write the direction field into .vdb outputs, as `direction`"},
     mapOption(),
     carryOptions()[0],
     {"adaptivity", "A", "0 to 1: merge flat parts of a mesh output, default 0"}},
    analogy};

}  // namespace vdbsynth::cli
