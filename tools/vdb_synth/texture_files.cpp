#include "tools/vdb_synth/texture_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/pipeline/texture/texture_repeat.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace vdbsynth::cli {

std::vector<SampleFiles> sampleFilesOf(const Arguments& arguments) {
    std::vector<SampleFiles> files;
    for (std::size_t i = 1; i < arguments.inputs.size(); ++i) {
        if (!isRasterPath(arguments.inputs[i]))
            throw Error(ErrorCode::InvalidOption,
                        arguments.inputs[i] + ": is no image; images are " + kRasterExtensions);
        files.push_back({arguments.inputs[i], {}});
    }
    // The n-th file of a name belongs to the n-th image.
    for (const std::string& text : arguments.all("channel")) {
        std::pair<std::string, std::string> map;
        readNamedImage(text, map);
        const auto lacks = [&](const SampleFiles& sample) {
            return std::none_of(sample.maps.begin(), sample.maps.end(),
                                [&](const auto& given) { return given.first == map.first; });
        };
        const auto sample = std::find_if(files.begin(), files.end(), lacks);
        if (sample == files.end())
            throw Error(ErrorCode::InvalidOption,
                        "--channel " + text + ": one " + map.first + " too many; give one for each image");
        sample->maps.push_back(map);
    }
    for (const SampleFiles& sample : files)
        if (sample.maps.size() != files.front().maps.size())
            throw Error(ErrorCode::InvalidOption,
                        "--channel: " + sample.colour + " lacks maps that " + files.front().colour +
                            " has; give each once for every image, in the images' order");
    requireMapNames(files);
    return files;
}

std::vector<TextureSample> loadSamples(Run& run, const std::vector<SampleFiles>& files, Tiling tiling) {
    std::vector<TextureSample> samples = readTextureSamples(files, tiling, run.context);
    nlohmann::json counts = nlohmann::json::array();
    for (std::size_t s = 0; s < files.size(); ++s) {
        run.noteInput(files[s].colour);
        for (const auto& [name, path] : files[s].maps) run.noteInput(path);
        samples[s].name = run.withoutTemporaries(samples[s].name);
        counts.push_back({{"name", samples[s].name},
                          {"width", samples[s].image.width},
                          {"height", samples[s].image.height},
                          {"tileable", samples[s].image.tileable}});
    }
    run.count("samples", counts);
    return samples;
}

Tiling tilingOf(const Arguments& arguments) {
    const std::string tile = arguments.text("tile");
    return tile == "yes" ? Tiling::Yes : tile == "no" ? Tiling::No : Tiling::Auto;
}

CoordinateOptions coordinateOptionsOf(const Arguments& arguments) {
    if (arguments.has("draft") && arguments.has("passes"))
        throw Error(ErrorCode::InvalidOption, "--draft and --passes: give one of them");
    if (arguments.has("max-rotation") && arguments.has("direction"))
        throw Error(ErrorCode::InvalidOption,
                    "--max-rotation: has no effect with --direction, which pieces follow within 8 degrees");
    CoordinateOptions options;
    options.levels = arguments.whole("levels");
    options.passes = arguments.has("draft") ? 0 : arguments.whole("passes");
    options.coherence = arguments.real("coherence");
    options.uniformity = arguments.real("uniformity");
    options.histogram = arguments.real("histogram");
    options.maxRotation = arguments.real("max-rotation");
    return options;
}

TextureOutputOptions textureOutputsOf(const Run& run) {
    TextureOutputOptions options;
    options.model = run.modelOptions();
    options.model.carry = true;
    options.bake = run.arguments.has("bake");
    options.bakeSize = run.arguments.whole("bake-size");
    options.bakeBits = run.arguments.text("bake-bits") == "16" ? 16 : 8;
    for (const char* name : {"bake-size", "bake-bits"})
        if (run.arguments.has(name) && !options.bake)
            throw Error(ErrorCode::InvalidOption, std::string("--") + name + ": is of --bake");
    return options;
}

void repeatTextureMap(Run& run) {
    const std::vector<std::string> paths = run.outputPaths();
    const std::string mapPath = run.arguments.inputs[0];
    const std::vector<SampleFiles> files = sampleFilesOf(run.arguments);
    TextureOutputOptions outputs = textureOutputsOf(run);
    requireOutputPaths(paths, outputs);
    for (const char* name : {"carry", "carry-blend", "adaptivity"})
        if (run.arguments.has(name))
            throw Error(ErrorCode::InvalidOption, std::string("--") + name + ": has no effect on a texture");
    run.reserveOutputs();
    if (!isTextureMap(mapPath))
        throw Error(ErrorCode::BadData,
                    mapPath + ": is no textured file: it has no comments vdbsynth:sample");
    TextureMap map = readTextureMap(mapPath, run.context);
    run.noteInput(mapPath);
    requireOutputs(map.shape, paths, outputs);
    std::vector<TextureSample> samples = loadSamples(run, files, Tiling::No);
    repeatTexture(map, samples, run.context);
    run.count("points", map.shape.points.size());
    outputs.metadata = run.metadata();
    writeTextured(map.shape, map.result, samples, paths, outputs, run.outputs(), run.context);
    run.finish();
}

}  // namespace vdbsynth::cli
