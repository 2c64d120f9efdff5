#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/map_place.h"
#include "tools/vdb_synth/mask_option.h"
#include "tools/vdb_synth/options.h"
#include "tools/vdb_synth/texture_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/analogy/analogy.h"
#include "libvdbsynth/pipeline/analogy/filter_analogy.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/pose/pose.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace vdbsynth::cli {
namespace {

constexpr double kMaskHalfWidth = 6;  // [voxels] of a mesh as mask: it fades in over three inside

AnalogyOptions parseOptions(const Arguments& arguments) {
    AnalogyOptions options;
    VolumeAnalogyOptions& synthesis = options.synthesis;
    synthesis.levels = arguments.whole("levels");
    synthesis.sweeps = arguments.whole("sweeps");
    // The library counts samples from the middle of a neighbourhood.
    synthesis.half = arguments.whole("samples") / 2;
    synthesis.coarseHalf = arguments.whole("coarse-samples") / 2;
    synthesis.components = arguments.whole("components");
    synthesis.coherence = arguments.real("coherence");
    if (arguments.has("exact")) synthesis.epsilon = 0;
    synthesis.causal = arguments.has("causal");
    synthesis.curvatureAdapted = !arguments.has("straight");
    synthesis.aligned = !arguments.has("naive");
    options.scale = arguments.real("scale");
    options.strength = arguments.real("strength");
    const std::string thin = arguments.text("thin");
    options.thin = thin == "keep" ? ThinParts::Keep : thin == "as-is" ? ThinParts::AsIs : ThinParts::Scale;
    options.draft = arguments.has("draft");
    options.halfWidth = float(arguments.real("half-width"));
    options.keepDirections = arguments.has("write-directions");
    for (const char* name : {"direction", "exemplar-direction"})
        if (arguments.has(name) && arguments.has("naive"))
            throw Error(
                ErrorCode::InvalidOption,
                std::string("--") + name + ": --naive works along the grid's axes and takes no direction");
    return options;
}

// What pairs, with the named options, are made of.
std::vector<std::string> madeOf(const Arguments& arguments, const std::vector<const char*>& options) {
    std::vector<std::string> paths(arguments.inputs.begin(), arguments.inputs.end() - 1);
    for (const char* name : options) {
        const std::string path = pathIn(*findOption("analogy", name), arguments.text(name));
        if (!path.empty()) paths.push_back(arguments.text(name));
    }
    return paths;
}

// A, A2, C, C2, ..., B. The second of a pair is loaded at the first's voxel size; the target has its own.
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
    // --voxel-size and --resolution apply to the target; a mesh A has --exemplar-resolution.
    pair.voxelSize = 0;
    pair.resolution = run.arguments.whole("exemplar-resolution");
    pair.grid.clear();
    pair.carry = true;
    for (std::size_t i = 0; i + 1 < inputs.size(); i += 2) {
        ModelOptions own = pair;
        models.pairs.push_back(run.load(inputs[i], own));
        const double voxelSize = voxelSizeOf(*models.pairs.back().grid);
        // A level set A2 has its own voxels, unless A was resampled.
        own.voxelSize = extensionOf(inputs[i + 1]) == "vdb" && pair.resolution == 0 ? 0 : voxelSize;
        own.resolution = 0;
        models.pairs.push_back(run.load(inputs[i + 1], own));
    }
    options.carry = true;
    // In the rest pose, if one is given: its mesh says where a place of B is.
    const bool posed = run.arguments.has("rest");
    options.keepSource = posed;
    models.target = run.load(posed ? run.arguments.text("rest") : inputs.back(), options);
    return models;
}

// @param now  the result was made for this frame
void report(Run& run, const AnalogyResult& result, bool now = true) {
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
    if (now)
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
                                             ": is a level set, but the first input is a scalar grid; give "
                                             "--iso to convert scalar grids, or give scalar grids only");
    return numbers;
}

// With --naive, scalar grids are filtered as they are, without conversion to level sets.
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
                "on held-out voxels the filter's RMS error is " +
                    roundedText(std::min(stats.affineError, stats.searchError) / stats.change, 3) +
                    " of its RMS change");
}

void filter(Run& run, const VolumeAnalogyOptions& synthesis) {
    const Arguments& arguments = run.arguments;
    for (const char* name :
         {"scale", "strength", "mask", "carry", "source-map", "write-directions", "causal", "straight",
          "sweeps", "thin", "draft", "coherence", "coarse-samples", "adaptivity", "map-types"})
        if (arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        "--" + std::string(name) + ": has no effect on scalar grids with --naive");
    FilterAnalogyOptions options;
    options.half = synthesis.half;
    options.components = synthesis.components;
    if (synthesis.levels > 0) options.levels = std::min(synthesis.levels, 4);
    for (const std::string& path : run.outputPaths())
        if (extensionOf(path) != "vdb")
            throw Error(ErrorCode::InvalidOption, path + ": scalar grids are written as .vdb only");
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

struct Pairs {
    std::shared_ptr<const PreparedPairs> prepared;
};

// Of a sequence they are prepared once, unless a size of the texture makes a scale for each frame.
std::shared_ptr<Pairs> preparedPairs(Run& run, const Models& models, const AnalogyOptions& options) {
    std::vector<AnalogyModelPair> pairs;
    for (std::size_t i = 0; i < models.pairs.size(); i += 2)
        pairs.push_back({&models.pairs[i], &models.pairs[i + 1]});
    return run.shared<Pairs>(
        "pairs at scale " + exactText(options.scale), madeOf(run.arguments, {"exemplar-direction"}),
        [&] { return std::make_shared<Pairs>(Pairs{preparePairs(pairs, options, run.context)}); });
}

// What the texture is made on, and the result there.
struct Made {
    LevelSet target;
    AnalogyResult result;
};

Made makeResult(Run& run, AnalogyOptions options) {
    Models models = loadModels(run);
    if (run.arguments.has("texture-size"))
        options.scale = scaleOfSize(run.arguments, longestSide(models.pairs.front()),
                                    voxelSizeOf(*models.target.grid), run.arguments.inputs.front());
    keepNamedAttributes(run.arguments, models.pairs);
    if (run.arguments.has("mask"))
        options.mask = maskOf(run, "mask", voxelSizeOf(*models.target.grid), kMaskHalfWidth);
    options.direction = directionOf(run, "direction");
    options.exemplarDirection = directionOf(run, "exemplar-direction");
    const auto pairs = preparedPairs(run, models, options);
    return {models.target, makeAnalogyModel(*pairs->prepared, models.target, options, run.context)};
}

// B in the pose of the frame: in the voxels of the pose at rest, with its mesh or its grid of places.
LevelSet loadPosed(Run& run, const LevelSet& rest) {
    const std::string& path = run.arguments.inputs.back();
    ModelOptions options = run.modelOptions();
    options.resolution = 0;
    options.voxelSize = extensionOf(path) == "vdb" ? options.voxelSize : voxelSizeOf(*rest.grid);
    options.keepSource = options.carry = true;
    return run.load(path, options);
}

// Before anything is made: the texture at rest may take minutes.
void requirePose(Run& run) {
    const std::string rest = run.arguments.text("rest"), posed = run.arguments.inputs.back();
    if (run.changesByFrame(rest))
        throw Error(ErrorCode::InvalidOption,
                    "--rest " + rest +
                        ": is another file for every frame, so that the texture would be made "
                        "anew each time and swim; name the one pose that it is made on");
    if (!isMeshPath(rest) || !isMeshPath(posed)) return;
    const Mesh from = readMesh(rest, run.context), to = readMesh(posed, run.context);
    // In triangles: of quads that are concave in one pose alone two are made.
    const auto counts = [](const Mesh& mesh) {
        return std::to_string(mesh.points.size()) + " vertices and " +
               std::to_string(mesh.triangles.size() + 2 * mesh.quads.size()) + " triangles";
    };
    if (counts(from) != counts(to))
        throw Error(ErrorCode::ShapeMismatch, posed + ": has " + counts(to) + ", " + rest + " (--rest) has " +
                                                  counts(from) +
                                                  "; poses of one mesh have the same vertices and faces");
}

// With the name of the file that is not a pose of what is at rest.
LevelSet poseOf(Run& run, const LevelSet& made, const LevelSet& rest, const LevelSet& posed,
                const PoseOptions& options) {
    try {
        return poseModel(made, rest, posed, options, run.context);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::Unusable && error.code() != ErrorCode::ShapeMismatch) throw;
        throw Error(error.code(), run.arguments.inputs.back() + ": " + error.what());
    }
}

void analogyInPose(Run& run, const AnalogyOptions& options, const std::vector<std::string>& paths) {
    if (run.arguments.has("source-map"))
        throw Error(ErrorCode::InvalidOption,
                    "--source-map: says where voxels of the rest pose come from; give it in a run without "
                    "--rest, with the rest pose as B");
    requirePose(run);
    run.reserveOutputs();
    bool now = false;
    // Only B and what is written differ.
    const std::vector<std::string> from =
        madeOf(run.arguments, {"rest", "mask", "direction", "exemplar-direction"});
    const auto made = run.shared<Made>("analogy at rest", from, [&] {
        now = true;
        return std::make_shared<Made>(makeResult(run, options));
    });
    if (!now)
        for (const std::string& path : from) run.noteInput(splitGridPath(path).file);
    LevelSet atRest = made->result.model;
    if (made->result.directions) atRest.attributes.push_back(made->result.directions);
    PoseOptions pose;
    pose.halfWidth = options.halfWidth;
    pose.reach = std::ceil(made->result.reach) + 1;
    const LevelSet posed = loadPosed(run, made->target);
    AnalogyResult result = made->result;
    result.model = poseOf(run, atRest, made->target, posed, pose);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity");
    run.describeOutputs(outputs);
    writeModel(result.model, paths, outputs, run.outputs(), run.context);
    report(run, result, now);
    run.finish();
}

void analogy(Run& run) {
    const Arguments& arguments = run.arguments;
    run.requireInputs(3, 33);
    if (arguments.inputs.size() % 2 == 0)
        throw Error(ErrorCode::InvalidOption,
                    "an even number of inputs; give pairs, each plain then textured, and the target last; "
                    "usage: vdb_synth " +
                        std::string(kAnalogy.usage));
    AnalogyOptions options = parseOptions(arguments);
    const std::vector<std::string> paths = run.outputPaths();
    if (isFilter(run)) {
        filter(run, options.synthesis);
        return;
    }
    const MapPlace place = mapPlaceOf(arguments, paths);
    if (options.keepDirections && !anyVdb(paths))
        throw Error(ErrorCode::InvalidOption, "--write-directions: needs a .vdb output");
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity");
    if (arguments.has("rest")) {
        analogyInPose(run, options, paths);
        return;
    }
    const Made made = makeResult(run, options);
    if (made.result.directions) outputs.extraGrids.push_back(made.result.directions);
    writeWithMap(run, made.result.model, made.result.map, place, paths, outputs);
    report(run, made.result);
    run.finish();
}

}  // namespace

const Command kAnalogy{
    "analogy", "analogy A A2 [C C2 ...] B -o OUT [options]",
    "Transfer the texture that A2 adds to A to another model B",
    "vdb_synth analogy A.vdb A2.vdb bunny.off --resolution 200 --direction axis:z -o grooved.vdb", analogy};

}  // namespace vdbsynth::cli
