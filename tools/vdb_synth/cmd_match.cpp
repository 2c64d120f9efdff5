#include "tools/vdb_synth/command.h"
#include "tools/vdb_synth/index_option.h"
#include "tools/vdb_synth/mask_option.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/match/match.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace vdbsynth::cli {
namespace {

// The bound that --tolerance guarantees and the values that --check measured.
std::string checked(const MatchOptions& options, const MatchResult& result) {
    if (options.tolerance == 0) return "";
    const auto line = [](const char* name, double value) {
        return ",\n  \"" + std::string(name) + "\": " + nlohmann::json(value).dump();
    };
    return line("tolerance", options.tolerance) +
           (options.check ? line("exactness_ratio", result.exactnessRatio) + line("recall", result.recall)
                          : "");
}

void match(Run& run) {
    run.requireInputs(2, 2);
    MatchOptions options;
    options.block = run.arguments.whole("block");
    options.count = run.arguments.whole("count");
    options.tolerance = run.arguments.real("tolerance");
    options.check = run.arguments.has("check");
    if (options.check && !run.arguments.has("tolerance"))
        throw Error(ErrorCode::InvalidOption, "--check: needs --tolerance; without it matches are exact");
    options.indexCache = indexFolder(run.arguments);
    if (!run.arguments.has("at"))
        throw Error(ErrorCode::InvalidOption,
                    "--at: missing; give the minimum corner of the block in the query's index space, for "
                    "example --at 0,0,0");
    options.at = run.arguments.wholeTriple("at");
    for (const std::string& path : run.arguments.inputs) requireModelPath(path);
    const LevelSet exemplar = run.load(run.arguments.inputs[0]);
    ModelOptions queryOptions = run.modelOptions();
    if (readExtensionOf(run.arguments.inputs[1]) != "vdb") {
        // All models are loaded at the first one's voxel size.
        queryOptions.voxelSize = voxelSizeOf(*exemplar.grid);
        queryOptions.resolution = 0;
    }
    const LevelSet query = run.load(run.arguments.inputs[1], queryOptions);
    if (run.arguments.has("mask")) options.mask = maskOf(run, "mask", voxelSizeOf(*query.grid));
    const MatchResult result = matchModel(exemplar, query, options, run.context);
    nlohmann::json matches = nlohmann::json::array();
    for (const BlockMatch& found : result.matches)
        matches.push_back({{"position", {found.position.x, found.position.y, found.position.z}},
                           {"cost", found.cost},
                           {"rms_voxels", std::sqrt(found.cost)}});
    // One match a line: thousands are easier to read and to split.
    std::string text = "{\n  \"block\": " + std::to_string(options.block) +
                       ",\n  \"at\": " + nlohmann::json{options.at.x, options.at.y, options.at.z}.dump() +
                       ",\n  \"known_samples\": " + std::to_string(result.known) + checked(options, result) +
                       ",\n  \"matches\": [";
    for (std::size_t i = 0; i < matches.size(); ++i) text += (i ? ",\n    " : "\n    ") + matches[i].dump();
    run.answer(text + "\n  ]\n}");
    run.count("bounds_computed", result.counts.nodes);
    run.count("exact_costs_computed", result.counts.exact);
    run.count("answered_by_correlation", result.counts.transforms);
    run.finish();
}

}  // namespace

const Command kMatch{"match", "match EXEMPLAR QUERY --block N --at I,J,K [-o OUT.json] [options]",
                     "Find the blocks of an exemplar that are most similar to one of another model, exactly",
                     "vdb_synth match grid.vdb more.vdb --block 16 --at 40,8,0 --count 3", match};

}  // namespace vdbsynth::cli
