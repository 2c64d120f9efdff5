#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/textured_mesh.h"
#include "libvdbsynth/pipeline/convert/outputs.h"
#include "libvdbsynth/pipeline/make/make.h"
#include "libvdbsynth/pipeline/make/make_points.h"
#include "libvdbsynth/procedural/analogy_pair.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace vdbsynth::cli {
namespace {

bool isPair(const std::string& kind) {
    const auto& kinds = analogyPairKinds();
    return std::any_of(kinds.begin(), kinds.end(), [&](const AnalogyPairKind& k) { return k.name == kind; });
}

// make KIND OUT OUT2: a plain model and a textured copy.
void makeTwo(Run& run, const MakeOptions& options) {
    const std::vector<std::string> paths(run.arguments.inputs.begin() + 1, run.arguments.inputs.end());
    if (paths.size() != 2 || run.arguments.has("output"))
        throw Error(ErrorCode::InvalidOption, "make " + options.exemplar.kind +
                                                  ": writes a pair; give two outputs: vdb_synth make " +
                                                  options.exemplar.kind + " A.vdb A2.vdb");
    if (run.arguments.has("size"))
        throw Error(ErrorCode::InvalidOption,
                    "--size: a pair's domain follows from --resolution and --feature");
    requireOutputPaths(paths);
    run.reserveOutputs();
    const double halfWidth = run.arguments.real("half-width");
    const ModelPair pair = makePair(options, run.context);
    ModelOutputOptions outputs;
    run.describeOutputs(outputs);
    outputs.metadata.emplace_back("vdbsynth:kind", options.exemplar.kind);
    writeModel(withHalfWidth(pair.plain, halfWidth, run.context), {paths[0]}, outputs, run.outputs(),
               run.context);
    writeModel(withHalfWidth(pair.textured, halfWidth, run.context), {paths[1]}, outputs, run.outputs(),
               run.context);
    run.describe(pair.textured);
    run.finish();
}

bool isPoints(const std::string& path) {
    return extensionOf(path) == "ply";
}

// The points of a texture, into the .ply files among the paths.
void makePly(Run& run, const MakeOptions& model, const std::vector<std::string>& paths) {
    MakePointsOptions options;
    options.model = model;
    options.spacing = run.arguments.real("spacing");
    if (run.arguments.has("margin")) options.margin = run.arguments.real("margin");
    const TexturePoints made = makePoints(options, run.context);
    std::vector<std::string> comments = textureBoxComments(made.box);
    comments.push_back("vdbsynth:kind " + model.exemplar.kind);
    for (const std::string& path : paths) {
        Stage stage(run.context, "writing " + path, 1);
        writePly(run.outputs().add(path), made.cloud, comments);
        stage.advance();
    }
    run.count("points", made.cloud.points.size());
}

void makeLevelSet(Run& run, const MakeOptions& options, const std::vector<std::string>& paths) {
    const LevelSet model =
        withHalfWidth(makeModel(options, run.context), run.arguments.real("half-width"), run.context);
    ModelOutputOptions outputs;
    run.describeOutputs(outputs);
    outputs.metadata.emplace_back("vdbsynth:kind", options.exemplar.kind);
    writeModel(model, paths, outputs, run.outputs(), run.context);
    run.describe(model);
}

void make(Run& run) {
    run.requireInputs(1, 3);
    MakeOptions options;
    options.exemplar.kind = run.arguments.inputs[0];
    options.exemplar.resolution = run.arguments.whole("resolution");
    options.exemplar.feature = run.arguments.real("feature");
    options.exemplar.size = run.arguments.wholeTriple("size");
    options.voxelSize = run.arguments.real("voxel-size");
    if (isPair(options.exemplar.kind)) {
        makeTwo(run, options);
        return;
    }
    run.requireInputs(1, 2);
    // The contract's form is "make KIND OUT"; -o works as everywhere else.
    std::vector<std::string> paths = run.arguments.all("output");
    if (run.arguments.inputs.size() == 2) paths.insert(paths.begin(), run.arguments.inputs[1]);
    if (paths.empty()) throw Error(ErrorCode::InvalidOption, "no output; usage: vdb_synth " + kMake.usage);
    requireOutputPaths(paths);
    run.reserveOutputs();
    const auto others = std::stable_partition(paths.begin(), paths.end(), isPoints);
    if (others != paths.begin()) makePly(run, options, {paths.begin(), others});
    if (others != paths.end()) makeLevelSet(run, options, {others, paths.end()});
    run.finish();
}

std::string summary() {
    std::string text = "Make a procedural exemplar: ";
    bool first = true;
    for (const ExemplarKind& kind : exemplarKinds()) {
        text += (first ? "" : ", ") + kind.name;
        first = false;
    }
    text += "; or a pair for analogy (OUT plain, OUT2 textured): ";
    first = true;
    for (const AnalogyPairKind& kind : analogyPairKinds()) {
        text += (first ? "" : ", ") + kind.name;
        first = false;
    }
    return text;
}

}  // namespace

const Command kMake{"make",
                    "make KIND OUT [OUT2] [options]",
                    summary(),
                    "vdb_synth make grid grid.vdb --seed 3",
                    make,
                    /* inputsAreOutputs= */ true};

}  // namespace vdbsynth::cli
