#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/mask_option.h"
#include "tools/vdb_synth/option_value.h"
#include "tools/vdb_synth/relief_base_option.h"
#include "tools/vdb_synth/texture_files.h"
#include "tools/vdb_synth/texture_region_option.h"
#include "tools/vdb_synth/texture_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/mesh_file.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/relief/relief.h"
#include "libvdbsynth/pipeline/relief/relief_bake.h"
#include "libvdbsynth/pipeline/texture/texture_sample.h"
#include "libvdbsynth/vdb/control_grids.h"
#include "libvdbsynth/vdb/read/field_kind.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>

namespace vdbsynth::cli {
namespace {

bool isPicture(const std::string& path) {
    const std::string extension = readExtensionOf(path);
    for (const char* known : {"png", "jpg", "jpeg", "pgm", "ppm", "pnm", "exr", "tif", "tiff"})
        if (extension == known) return true;
    return false;
}

ReliefOptions parseOptions(const Arguments& arguments) {
    ReliefOptions options;
    options.method = arguments.text("method") == "paper" ? ReliefMethod::Paper : ReliefMethod::Default;
    options.base = baseKindOf(arguments.text("base"));
    options.baseRadius = arguments.real("base-radius");
    options.wholeSample = arguments.has("whole-sample");
    options.scale = arguments.real("scale");
    options.strength = arguments.real("strength");
    options.minWall = arguments.real("min-wall");
    options.neighbourhood = arguments.real("neighbourhood");
    options.top = arguments.real("top");
    options.fade = arguments.real("fade");
    options.fit = arguments.has("fit");
    options.halfWidth = float(arguments.real("half-width"));
    options.synthesis = coordinateOptionsOf(arguments);
    const bool paper = options.method == ReliefMethod::Paper;
    for (const char* name : {"neighbourhood", "top"})
        if (arguments.has(name) && !paper)
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": has no effect without --method paper");
    for (const char* name :
         {"levels", "passes", "draft", "coherence", "uniformity", "histogram", "max-rotation", "min-wall"})
        if (arguments.has(name) && paper)
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": has no effect with --method paper");
    return options;
}

// What only pictures, or only scans, take.
void checkSamples(const Arguments& arguments) {
    const auto first = arguments.inputs.begin(), last = arguments.inputs.end() - 1;
    const auto pictures = std::count_if(first, last, isPicture);
    if (pictures == 0)
        for (const char* name : {"height", "pixel-size", "tile", "fit"})
            if (arguments.has(name))
                throw Error(ErrorCode::InvalidOption,
                            std::string("--") + name + ": has no effect, as no SAMPLE is a picture");
    if (pictures == last - first)
        for (const char* name :
             {"base", "base-radius", "exemplar-direction", "exemplar-resolution", "whole-sample"})
            if (arguments.has(name))
                throw Error(ErrorCode::InvalidOption,
                            std::string("--") + name + ": has no effect on pictures, only on scans");
    if (pictures > 0 && arguments.text("method") == "paper")
        throw Error(ErrorCode::InvalidOption, "--method paper: takes scans, no pictures of heights");
    if (last - first > 1 && !arguments.has("region"))
        throw Error(ErrorCode::InvalidOption,
                    arguments.inputs[1] +
                        ": several samples need --region auto or --region MODEL, which say "
                        "where each goes");
    if (last - first == 1 && arguments.has("region"))
        throw Error(ErrorCode::InvalidOption, "--region: needs several samples");
}

// The mean of a picture's channels, 0 to 1; real numbers are heights as they are unless --height is given.
void takeHeights(const Run& run, const std::string& path, const TextureSample& sample, ReliefSource& source) {
    SampleImage heights{sample.image.width, sample.image.height, 1, sample.image.tileable, {},
                        sample.image.valid};
    const std::size_t channels = std::size_t(sample.image.channels);
    for (std::size_t i = 0; i < sample.image.texels(); ++i) {
        float sum = 0;
        for (std::size_t c = 0; c < channels; ++c) sum += sample.image.values[i * channels + c];
        heights.values.push_back(sum / float(channels));
    }
    source.height = run.arguments.real("height");
    if (sample.maps.front().white == 0) {
        const auto [low, high] = std::minmax_element(heights.values.begin(), heights.values.end());
        const float from = *low, range = *high - *low;
        if (!(source.height > 0) && range > 0) {
            source.height = double(range);
            message(run.context, MessageLevel::Note,
                    path + ": its values are real numbers and taken as heights, over a range of " +
                        roundedText(source.height, 4) + " (world); --height gives another range");
        }
        for (float& v : heights.values) v = range > 0 ? (v - from) / range : 0;
    }
    source.heights = std::move(heights);
}

struct Samples {
    std::vector<LevelSet> scans;
    std::vector<ReliefSource> sources;
};

Samples loadSamples(Run& run) {
    const Arguments& arguments = run.arguments;
    const std::size_t count = arguments.inputs.size() - 1;
    ModelOptions model = run.modelOptions();
    model.voxelSize = 0;
    model.resolution = arguments.whole("exemplar-resolution");
    model.grid.clear();
    Samples samples;
    samples.scans.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::string& path = arguments.inputs[i];
        ReliefSource source;
        if (isPicture(path)) {
            takeHeights(run, path, readTextureSamples({{path, {}}}, tilingOf(arguments), run.context).front(),
                        source);
            run.noteInput(path);
            const std::vector<double> sides = arguments.lengths("pixel-size");
            if (sides.size() > 1 && sides[0] != sides[1])
                throw Error(ErrorCode::InvalidOption,
                            "--pixel-size: pixels of a relief are squares; give one side");
            source.pixelSize = sides.empty() ? 0 : sides[0];
        } else {
            samples.scans.push_back(run.load(path, model));
            source.scan = &samples.scans.back();
        }
        samples.sources.push_back(std::move(source));
    }
    return samples;
}

struct Mask {
    LevelSet model;
    bool isModel = false;
};

// A named grid, or the only one of a file that is no solid.
bool isGridOfWeights(Run& run, const std::string& text) {
    if (!namesGrid(text)) return false;
    const auto [path, name] = splitGridPath(text);
    if (!name.empty()) return true;
    const std::vector<GridPtr> grids = readVdbGrids(path, run.context);
    if (grids.size() != 1) return false;
    const FloatGridPtr field = asFloat(grids.front());
    return !field || kindOf(*field, run.context) == FieldKind::Density;
}

Mask loadMask(Run& run, double voxelSize, ReliefOptions& options) {
    Mask mask;
    if (!run.arguments.has("mask")) {
        if (options.fade > 0) throw Error(ErrorCode::InvalidOption, "--fade: needs a model as --mask");
        return mask;
    }
    const std::string text = run.arguments.text("mask");
    if (isGridOfWeights(run, text)) {
        if (options.fade > 0)
            throw Error(ErrorCode::InvalidOption, "--fade: has no effect on a grid of weights as --mask");
        options.mask = run.loadGrid("mask");
        return mask;
    }
    refusePicture(run.arguments, "mask");
    ModelOptions model;
    if (extensionOf(text) != "vdb") model.voxelSize = voxelSize;
    mask.model = run.load(text, model);
    mask.isModel = true;
    return mask;
}

bool isBaked(const std::string& path) {
    return extensionOf(path) == "png" || extensionOf(path) == "exr";
}

// The outputs that are pictures on the target's coordinates; what is left are models.
std::vector<std::string> takeBaked(const Arguments& arguments, std::vector<std::string>& paths) {
    std::vector<std::string> baked;
    if (!arguments.has("bake")) {
        for (const char* name : {"bake-size", "bake-bits"})
            if (arguments.has(name))
                throw Error(ErrorCode::InvalidOption,
                            std::string("--") + name + ": has no effect without --bake");
        return baked;
    }
    std::copy_if(paths.begin(), paths.end(), std::back_inserter(baked), isBaked);
    paths.erase(std::remove_if(paths.begin(), paths.end(), isBaked), paths.end());
    if (baked.empty()) throw Error(ErrorCode::InvalidOption, "--bake: needs a .png or .exr output");
    if (!isMeshPath(arguments.inputs.back()))
        throw Error(ErrorCode::InvalidOption,
                    "--bake: " + arguments.inputs.back() + " is no mesh with texture coordinates");
    for (const std::string& path : baked)
        if (bakedReliefOf(path) == BakedRelief::Vector && extensionOf(path) != "exr")
            throw Error(ErrorCode::InvalidOption, path + ": vectors are written as .exr");
    return baked;
}

void bake(Run& run, const std::vector<std::string>& paths, const ReliefResult& result) {
    if (paths.empty()) return;
    const std::string& name = run.arguments.inputs.back();
    Mesh mesh = readMesh(name, run.context);
    const double scale = run.modelOptions().unitScale;
    mesh.origin = mesh.origin * scale;
    for (Vec3f& p : mesh.points) p = p * float(scale);
    ReliefBakeOptions options;
    options.size = run.arguments.whole("bake-size");
    options.bits = run.arguments.text("bake-bits") == "8" ? 8 : 16;
    options.reach = result.reach;
    for (const std::string& path : paths)
        bakeRelief(mesh, result.model, name, path, options, run.outputs(), run.context);
}

void report(Run& run, const ReliefResult& result, const ReliefOptions& options) {
    nlohmann::json levels = nlohmann::json::array();
    for (const CoordinateLevelStats& level : result.levels)
        levels.push_back({{"sites", level.sites},
                          {"step_texels", level.step},
                          {"coherent_share", level.coherent},
                          {"feature_distance", level.cost}});
    run.count("levels", levels);
    run.count("texel", result.texel);
    if (result.baseRadius > 0) run.count("base_radius", result.baseRadius);
    run.count("flattened_share", result.covered);
    run.count("folds", result.folds);
    run.count("singularities", result.singularities.size());
    run.count("unchanged_share", result.unchanged);
    if (options.fit) run.count("fitted", result.fitted);
    if (options.method == ReliefMethod::Paper) run.count("mismatch", result.mismatch);
    message(run.context, MessageLevel::Note,
            "a voxel of the sample is " + roundedText(result.texel, 4) + " wide on the target (world)" +
                (result.folds ? "; the relief folds, so its distances were copied, overhangs included" : ""));
    run.describe(result.model);
}

void relief(Run& run) {
    const Arguments& arguments = run.arguments;
    run.requireInputs(2, 33);
    ReliefOptions options = parseOptions(arguments);
    checkSamples(arguments);
    std::vector<std::string> paths = run.outputPaths();
    const std::vector<std::string> baked = takeBaked(arguments, paths);
    requireOutputPaths(paths);
    for (const std::string& path : arguments.inputs) requireModelPath(path);
    run.reserveOutputs();
    const Samples samples = loadSamples(run);
    ModelOptions model = run.modelOptions();
    // Painted masks come with the target's attributes.
    model.carry = arguments.has("mask-attribute") || arguments.has("mask-image");
    const LevelSet target = run.load(arguments.inputs.back(), model);
    if (arguments.has("texture-size")) {
        const ReliefSource& first = samples.sources.front();
        const double side = first.scan ? longestSide(*first.scan)
                                       : double(std::max(first.heights.width, first.heights.height));
        const double unit = first.pixelSize > 0 ? first.pixelSize : voxelSizeOf(*target.grid);
        options.scale = scaleOfSize(arguments, side, unit, arguments.inputs.front());
    }
    const Mask mask = loadMask(run, voxelSizeOf(*target.grid), options);
    if (mask.isModel) options.maskModel = &mask.model;
    options.maskAttribute = arguments.text("mask-attribute");
    if (arguments.has("mask-image")) {
        options.maskImage =
            readTextureSamples({{arguments.text("mask-image"), {}}}, Tiling::No, run.context).front().image;
        run.noteInput(arguments.text("mask-image"));
    }
    if (arguments.has("direction")) options.direction = directionOf(run, "direction");
    if (arguments.has("exemplar-direction"))
        options.exemplarDirection = directionOf(run, "exemplar-direction");
    ReliefLabels labels;
    if (samples.sources.size() > 1)
        labels = [&](const TextureShape& sites) { return regionLabels(run, sites, samples.sources.size()); };
    const ReliefResult result = transferRelief(samples.sources, target, labels, options, run.context);
    ModelOutputOptions outputs;
    outputs.adaptivity = arguments.real("adaptivity");
    outputs.extraGrids = result.sources;
    run.describeOutputs(outputs);
    if (!paths.empty()) writeModel(result.model, paths, outputs, run.outputs(), run.context);
    bake(run, baked, result);
    report(run, result, options);
    run.finish();
}

}  // namespace

const Command kRelief{"relief", "relief SAMPLE... TARGET -o OUT [options]",
                      "Take the relief off one surface, or a picture, and grow it on another",
                      "vdb_synth relief dragon.off 3holes.off -o carved.obj", relief};

}  // namespace vdbsynth::cli
