#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/patch_files.h"
#include "tools/vdb_synth/texture_files.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/hash.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/repeat/repeat.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace vdbsynth::cli {
namespace {

// The inputs that follow MAP, as the usage line names them.
std::string wanted(const SourceMap& map) {
    std::string text;
    const bool analogy = map.method == MapMethod::Analogy;
    const std::size_t target = map.method == MapMethod::Synthesis ? 0 : 1;
    for (std::size_t e = 0; e + target < map.inputs(); ++e) {
        text += analogy ? " A2" : " EXEMPLAR";
        if (map.exemplars.size() > 1) text += std::to_string(e + 1);
    }
    return text + (target == 0 ? "" : analogy ? " B" : " KEPT");
}

// Hashes of the run's input files in the order in which repeat takes them; empty if the map's file does not
// record them, as when another program wrote it.
std::vector<std::string> filesOf(const SourceMap& map, const VdbMetadata& metadata) {
    std::vector<std::string> all, ordered;
    for (const auto& [name, value] : metadata) {
        if (name != "vdbsynth:inputs") continue;
        const nlohmann::json inputs = nlohmann::json::parse(value, nullptr, /* allow_exceptions= */ false);
        if (!inputs.is_array()) return {};
        for (const nlohmann::json& input : inputs)
            all.push_back(input.is_object() ? input.value("hash", std::string()) : std::string());
    }
    // Commands record their inputs as they load them: synth its exemplars; synth --keep the kept model, the
    // hole's if it is a file, and the exemplar last; analogy A, A2 for each pair, then B.
    const std::size_t exemplars = map.exemplars.size();
    if (map.method == MapMethod::Synthesis && all.size() >= exemplars)
        ordered.assign(all.begin(), all.begin() + std::ptrdiff_t(exemplars));
    if (map.method == MapMethod::Analogy && all.size() > 2 * exemplars) {
        for (std::size_t e = 0; e < exemplars; ++e) ordered.push_back(all[2 * e + 1]);
        ordered.push_back(all[2 * exemplars]);
    }
    if (map.method == MapMethod::Fill && !map.hole.fromSelf && all.size() >= 2)
        ordered = {all.back(), all.front()};
    return ordered;
}

// Refuses the run's own models in another order: the result would be nonsense.
void requireOrder(const Run& run, const SourceMap& map, const VdbMetadata& metadata) {
    const std::vector<std::string>& inputs = run.arguments.inputs;
    const std::vector<std::string> files = filesOf(map, metadata);
    if (files.size() + 1 != inputs.size()) return;
    for (std::size_t i = 0; i < files.size(); ++i) {
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(inputs[i + 1], ignored)) return;  // its reader fails
        const std::string hash = fileHash(inputs[i + 1]);
        if (hash == files[i]) continue;
        for (std::size_t j = 0; j < files.size(); ++j)
            if (hash == files[j])
                throw Error(ErrorCode::ShapeMismatch,
                            run.withoutTemporaries(inputs[i + 1]) + ": was model " + std::to_string(j + 1) +
                                " of the map's run and is model " + std::to_string(i + 1) +
                                " here; the order is repeat MAP" + wanted(map));
    }
}

// Maps of single voxels or of a hole fix the voxel sizes of their models.
void requireNoSize(const Run& run, const SourceMap& map) {
    if (map.method == MapMethod::Synthesis) return;
    for (const char* name : {"voxel-size", "resolution"})
        if (run.arguments.has(name))
            throw Error(ErrorCode::InvalidOption,
                        std::string("--") + name + ": the map of " +
                            (map.method == MapMethod::Fill ? "a filled hole" : "an analogy") +
                            " fixes the voxel sizes of its models" +
                            (map.method == MapMethod::Fill
                                 ? ""
                                 : "; for a finer result convert A2 to a half or a third of its voxels"));
}

// Loads every model at the voxel size that the map requires. The first .vdb exemplar may be finer; the other
// models are then loaded finer by the same factor.
std::vector<LevelSet> loadInputs(Run& run, const SourceMap& map) {
    const std::vector<std::string> paths(run.arguments.inputs.begin() + 1, run.arguments.inputs.end());
    ModelOptions options = run.modelOptions();
    const bool sized = options.voxelSize > 0 || options.resolution > 0;
    options.halfWidth = 3;
    options.carry = true;
    std::vector<LevelSet> models;
    double factor = 1;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        const bool target = map.method != MapMethod::Synthesis && i + 1 == paths.size();
        const bool own = extensionOf(paths[i]) == "vdb" && (models.empty() || map.method == MapMethod::Fill);
        ModelOptions of = options;
        if (!own && !(sized && models.empty())) {
            of.voxelSize = (target ? map.target.voxelSize : map.voxelSize) / factor;
            of.resolution = 0;
        }
        if (map.method == MapMethod::Analogy && !target) of.grid.clear();
        models.push_back(run.load(paths[i], of));
        if (models.size() == 1 && !target)
            factor = std::max(1.0, std::round(map.voxelSize / voxelSizeOf(*models.front().grid)));
    }
    return models;
}

void repeat(Run& run) {
    run.requireInputs(2, 66);
    const std::vector<std::string> paths = run.outputPaths();
    const std::string mapPath = run.arguments.inputs[0];
    if (readExtensionOf(mapPath) == "ply") return repeatTextureMap(run);
    if (extensionOf(mapPath) != "vdb")
        throw Error(ErrorCode::InvalidOption,
                    mapPath + ": a source map is a .vdb file, or of a texture a .ply file");
    for (const char* name : {"channel", "bake", "bake-size", "bake-bits"})
        if (run.arguments.has(name))
            throw Error(ErrorCode::InvalidOption, std::string("--") + name + ": is of a texture's .ply map");
    for (std::size_t i = 1; i < run.arguments.inputs.size(); ++i) requireModelPath(run.arguments.inputs[i]);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity");
    RepeatOptions options;
    options.carried = attributeValues(run.arguments);
    if (run.arguments.has("half-width")) options.halfWidth = float(run.modelOptions().halfWidth);
    if (run.arguments.has("origin")) {
        const std::array<double, 3> origin = run.arguments.triple("origin");
        options.origin = Vec3d{origin[0], origin[1], origin[2]};
    }
    const VdbContents contents = readVdb(mapPath, run.context);
    run.noteInput(mapPath);
    if (const auto patches = patchMapFrom(mapPath, contents.grids)) return repeatPatchMap(run, *patches);
    if (const auto onto = patchOntoMapFrom(mapPath, contents.grids)) return repeatPatchOntoMap(run, *onto);
    const SourceMap map = sourceMapFrom(mapPath, contents.grids, run.context);
    if (run.arguments.inputs.size() - 1 != map.inputs())
        throw Error(ErrorCode::ShapeMismatch,
                    mapPath + ": repeat this map as: repeat MAP" + wanted(map) + "; " +
                        std::to_string(run.arguments.inputs.size() - 1) +
                        (run.arguments.inputs.size() == 2 ? " model was" : " models were") +
                        " given after it");
    requireNoSize(run, map);
    requireOrder(run, map, contents.metadata);
    std::vector<LevelSet> models = loadInputs(run, map);
    keepNamedAttributes(run.arguments, models);
    std::vector<const LevelSet*> pointers;
    for (const LevelSet& model : models) pointers.push_back(&model);
    const LevelSet result = repeatMap(map, pointers, options, run.context);
    run.describeOutputs(outputs);
    writeModel(result, paths, outputs, run.outputs(), run.context);
    run.describe(result);
    run.finish();
}

}  // namespace

const Command kRepeat{
    "repeat",
    "repeat MAP EXEMPLAR... -o OUT [options] | repeat MAP A2... B -o OUT (an analogy's "
    "map) | repeat MAP [EXEMPLAR] KEPT -o OUT (a map of synth --keep) | repeat TEXTURED.ply "
    "IMAGE... -o OUT",
    "Apply a saved source map again", "vdb_synth repeat map.vdb grid.vdb -o again.vdb", repeat};

}  // namespace vdbsynth::cli
