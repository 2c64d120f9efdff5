#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/outputs.h"
#include "libvdbsynth/pipeline/repeat.h"
#include "libvdbsynth/vdb/source_map_grids.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth::cli {
namespace {

// The models that a map is repeated on, as the command line has them.
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

// Every model at the voxel size that the map asks of it. A .vdb of exemplars may be finer; all else follows.
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
        ModelOptions own = options;
        if (target || models.size() > 0) {
            own.voxelSize = target ? map.target.voxelSize / factor : map.voxelSize / factor;
            own.resolution = 0;
        } else if (!sized && extensionOf(paths[i]) != "vdb") {
            own.voxelSize = map.voxelSize;
        }
        if (map.method == MapMethod::Analogy && !target) own.grid.clear();
        models.push_back(run.load(paths[i], own));
        if (models.size() == 1 && !target)
            factor = std::max(1.0, std::round(map.voxelSize / voxelSizeOf(*models.front().grid)));
    }
    return models;
}

void repeat(Run& run) {
    run.requireInputs(2, 66);
    const std::vector<std::string> paths = run.outputPaths();
    const std::string mapPath = run.arguments.inputs[0];
    if (extensionOf(mapPath) != "vdb")
        throw Error(ErrorCode::InvalidOption, mapPath + ": a source map is a .vdb file");
    for (std::size_t i = 1; i < run.arguments.inputs.size(); ++i) requireModelPath(run.arguments.inputs[i]);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity");
    RepeatOptions options;
    options.carried = carriedValues(run.arguments);
    if (run.arguments.has("half-width")) options.halfWidth = float(run.modelOptions().halfWidth);
    const SourceMap map = readSourceMap(mapPath, run.context);
    run.noteInput(mapPath);
    if (run.arguments.inputs.size() - 1 != map.inputs())
        throw Error(ErrorCode::ShapeMismatch, mapPath + ": its map is repeated as: repeat MAP" + wanted(map) +
                                                  "; " + std::to_string(run.arguments.inputs.size() - 1) +
                                                  " models are given after it");
    std::vector<LevelSet> models = loadInputs(run, map);
    keepCarried(run.arguments, models);
    std::vector<const LevelSet*> pointers;
    for (const LevelSet& model : models) pointers.push_back(&model);
    const LevelSet result = repeatMap(map, pointers, options, run.context);
    outputs.metadata = run.metadata();
    writeModel(result, paths, outputs, run.outputs(), run.context);
    run.describe(result);
    run.finish();
}

}  // namespace

const Command kRepeat{"repeat",
                      "repeat MAP EXEMPLAR... -o OUT [options] | repeat MAP A2... B -o OUT (an analogy's "
                      "map) | repeat MAP [EXEMPLAR] KEPT -o OUT (a map of synth --keep)",
                      "Apply a saved source map again", "vdb_synth repeat map.vdb grid.vdb -o again.vdb",
                      repeat};

}  // namespace vdbsynth::cli
