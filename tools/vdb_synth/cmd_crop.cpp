#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/world_box.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/crop/crop.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

void crop(Run& run) {
    run.requireInputs(1, 1);
    const std::vector<std::string> paths = run.outputPaths();
    if (!run.arguments.has("box"))
        throw Error(ErrorCode::InvalidOption,
                    "--box: missing; give i,j,k,I,J,K in index space, both corners inclusive, or lengths "
                    "such as 1.5w (world)");
    requireModelPath(run.arguments.inputs[0]);
    ModelOptions options = run.modelOptions();
    options.carry = true;
    const LevelSet model = run.load(run.arguments.inputs[0], options);
    const IndexBox box =
        voxelsOf(run.arguments.box("box"), transformOf(*model.grid), "--box " + run.arguments.text("box"));
    const LevelSet result = withHalfWidth(cropModel(model, box, run.context), options.halfWidth, run.context);
    ModelOutputOptions outputs;
    run.describeOutputs(outputs);
    writeModel(result, paths, outputs, run.outputs(), run.context);
    run.describe(result);
    run.finish();
}

}  // namespace

const Command kCrop{"crop", "crop IN -o OUT --box BOX [options]",
                    "Cut a box out of a model and record it as its domain",
                    "vdb_synth crop grid.vdb -o part.vdb --box 8,8,8,39,39,39", crop};

}  // namespace vdbsynth::cli
