#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/direction_option.h"
#include "tools/vdb_synth/texture_files.h"
#include "tools/vdb_synth/texture_region_option.h"
#include "tools/vdb_synth/texture_size.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/texture/texture.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace vdbsynth::cli {
namespace {

constexpr double kFewShown = 0.1;  // share of an image's pixels below which a note says so

struct OfMethods {
    const char* option;
    std::vector<std::string> methods;
};

const std::vector<OfMethods> kOfMethods{{"passes", {"default"}},
                                        {"coherence", {"default"}},
                                        {"uniformity", {"default"}},
                                        {"histogram", {"default"}},
                                        {"max-rotation", {"default"}},
                                        {"blend", {"default", "parameterize"}},
                                        {"draft", {"default"}},
                                        {"neighbours", {"parameterize", "match", "hybrid"}},
                                        {"levels", {"default", "match", "hybrid"}},
                                        {"coherent", {"match"}},
                                        {"match-sample", {"hybrid"}}};

void refuseOtherMethods(const Arguments& arguments) {
    const std::string method = arguments.text("method");
    for (const OfMethods& of : kOfMethods)
        if (arguments.has(of.option) &&
            std::find(of.methods.begin(), of.methods.end(), method) == of.methods.end())
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + of.option + ": has no effect with --method " + method);
    if (arguments.has("scale") && arguments.has("texture-size"))
        throw Error(ErrorCode::InvalidOption, "--scale and --texture-size: give one of them");
    if (arguments.has("displace") != arguments.has("amplitude"))
        throw Error(ErrorCode::InvalidOption,
                    "--displace and --amplitude: give both, the map and the height of its white (world)");
}

TextureMethod methodOf(const std::string& word) {
    return word == "parameterize" ? TextureMethod::Parameterize
           : word == "match"      ? TextureMethod::Match
           : word == "hybrid"     ? TextureMethod::Hybrid
                                  : TextureMethod::Default;
}

TextureOptions parseOptions(const Arguments& arguments) {
    refuseOtherMethods(arguments);
    TextureOptions options;
    options.method = methodOf(arguments.text("method"));
    options.scale = arguments.real("scale");
    options.levels = arguments.whole("levels");
    options.regionBlend = arguments.real("region-blend");
    options.neighbours = arguments.whole("neighbours");
    options.coherent = arguments.has("coherent");
    options.matchSample = arguments.whole("match-sample");
    options.synthesis = coordinateOptionsOf(arguments);
    const std::string blend = arguments.text("blend");
    options.blend = blend == "off" || (arguments.has("draft") && !arguments.has("blend")) ? SampleBlend::Off
                    : blend == "weight"    ? SampleBlend::Weight
                    : blend == "histogram" ? SampleBlend::Histogram
                                           : SampleBlend::Automatic;
    validate(options);
    return options;
}

void checkDisplacement(const Arguments& arguments, const std::vector<SampleFiles>& files) {
    if (!arguments.has("displace")) return;
    const std::string map = arguments.text("displace");
    const auto& maps = files.front().maps;
    if (std::none_of(maps.begin(), maps.end(), [&](const auto& given) { return given.first == map; }))
        throw Error(ErrorCode::InvalidOption,
                    "--displace " + map + ": is no map; add it with --channel " + map + "=FILE");
}

std::optional<TargetKind> kindOf(const Arguments& arguments) {
    const std::string as = arguments.text("as");
    if (as == "points") return TargetKind::Points;
    if (as == "mesh") return TargetKind::Mesh;
    if (as == "levelset") return TargetKind::LevelSet;
    return std::nullopt;
}

// Voxels are only those of a level set, or of OpenVDB points.
void noteUnusedVoxels(const Run& run, const TextureShape& shape, const std::vector<std::string>& paths) {
    const bool vdb = std::any_of(paths.begin(), paths.end(),
                                 [](const std::string& path) { return extensionOf(path) == "vdb"; });
    for (const char* name : {"voxel-size", "resolution", "half-width"}) {
        const bool points = shape.kind == TargetKind::Points && (!vdb || std::string(name) != "voxel-size"),
                   mesh = shape.kind == TargetKind::Mesh && !vdb;
        if (run.arguments.has(name) && (points || mesh))
            message(run.context, MessageLevel::Note,
                    std::string("--") + name + " has no effect: no level set is made");
    }
}

void report(Run& run, const TextureShape& shape, const SampleImage& image, const TextureResult& result) {
    nlohmann::json levels = nlohmann::json::array();
    for (const CoordinateLevelStats& level : result.levels)
        levels.push_back({{"sites", level.sites},
                          {"step_texels", level.step},
                          {"coherent_share", level.coherent},
                          {"feature_distance", level.cost}});
    run.count("points", shape.points.size());
    run.count("sites", shape.site.size());
    run.count("texel", result.texel);
    run.count("levels", levels);
    message(run.context, MessageLevel::Note,
            std::to_string(shape.points.size()) + (shape.triangles.empty() ? " points" : " vertices") +
                "; a pixel of the image is " + roundedText(result.texel, 4) + " wide (world)");
    // Shown at one pixel a point, at most.
    const double texels = double(image.texels()), shown = double(shape.site.size()) / texels;
    if (shown < kFewShown)
        message(
            run.context, MessageLevel::Note,
            "so few points show " + roundedText(100 * shown, 2) +
                " % of the image's pixels, a piece of it enlarged; --as levelset --resolution N makes more "
                "points, and with a --scale below 1 pictures of .glb and --bake show more of it");
}

void texture(Run& run) {
    run.requireInputs(2, 65);
    const Arguments& arguments = run.arguments;
    TextureOptions options = parseOptions(arguments);
    const std::vector<std::string> paths = run.outputPaths();
    const std::vector<SampleFiles> files = sampleFilesOf(arguments);
    checkRegions(arguments, files);
    checkDisplacement(arguments, files);
    TextureOutputOptions outputs = textureOutputsOf(run);
    requireOutputPaths(paths, outputs);
    requireModelPath(arguments.inputs[0]);
    run.reserveOutputs();
    const std::vector<TextureSample> samples = loadSamples(run, files, tilingOf(arguments));
    TextureShape shape = loadTarget(arguments.inputs[0], kindOf(arguments), outputs.model, run.context);
    run.noteInput(arguments.inputs[0]);
    requireOutputs(shape, paths, outputs);
    if (arguments.has("texture-size")) {
        const SampleImage& first = samples.front().image;
        options.scale = scaleOfImage(arguments, double(std::max(first.width, first.height)),
                                     siteSpacing(shape, run.context));
    }
    noteUnusedVoxels(run, shape, paths);
    noteUnblended(run, files, paths);
    if (arguments.has("direction")) options.direction = directionOf(run, "direction");
    const std::vector<std::int32_t> labels = regionLabels(run, shape, samples.size());
    const TextureResult result = textureShape(shape, samples, labels, options, run.context);
    if (arguments.has("displace"))
        displace(shape, result, samples, arguments.text("displace"), arguments.real("amplitude"));
    outputs.metadata = run.metadata();
    writeTextured(shape, result, samples, paths, outputs, run.outputs(), run.context);
    report(run, shape, samples.front().image, result);
    run.finish();
}

}  // namespace

const Command kTexture{"texture", "texture TARGET IMAGE... -o OUT [options]",
                       "Colour points, a mesh or a level set like an image",
                       "vdb_synth texture bunny.off brick.png -o bunny.ply -o bunny.glb -o bunny.vdb",
                       texture};

}  // namespace vdbsynth::cli
