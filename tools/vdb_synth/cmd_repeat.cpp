#include "tools/vdb_synth/carry_options.h"
#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/outputs.h"
#include "libvdbsynth/pipeline/synth.h"

namespace vdbsynth::cli {
namespace {

void repeat(Run& run) {
    run.requireInputs(2, 65);
    const std::vector<std::string> paths = run.outputPaths();
    const std::string mapPath = run.arguments.inputs[0];
    if (extensionOf(mapPath) != "vdb")
        throw Error(ErrorCode::InvalidOption, mapPath + ": a source map is a .vdb file");
    for (std::size_t i = 1; i < run.arguments.inputs.size(); ++i) requireModelPath(run.arguments.inputs[i]);
    ModelOutputOptions outputs;
    outputs.adaptivity = run.arguments.real("adaptivity");
    ModelOptions modelOptions = run.modelOptions();
    modelOptions.carry = true;
    SourceMap map = readSourceMap(mapPath, run.context);
    run.noteInput(mapPath);
    if (run.arguments.has("half-width")) map.halfWidth = float(modelOptions.halfWidth);
    std::vector<LevelSet> exemplars;
    std::vector<const LevelSet*> pointers;
    for (std::size_t i = 1; i < run.arguments.inputs.size(); ++i)
        exemplars.push_back(run.load(run.arguments.inputs[i], modelOptions));
    keepCarried(run.arguments, exemplars);
    for (const LevelSet& exemplar : exemplars) pointers.push_back(&exemplar);
    const LevelSet result = repeatSynthesis(map, pointers, run.context, carriedValues(run.arguments));
    outputs.metadata = run.metadata();
    writeModel(result, paths, outputs, run.outputs(), run.context);
    run.describe(result);
    run.finish();
}

}  // namespace

const Command kRepeat{"repeat", "repeat MAP EXEMPLAR... -o OUT [options]", "Apply a saved source map again",
                      "vdb_synth repeat map.vdb grid.vdb -o again.vdb", repeat};

}  // namespace vdbsynth::cli
