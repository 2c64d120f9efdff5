#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/compare.h"
#include "libvdbsynth/vdb/preview.h"
#include "tools/vdb_synth/compare_report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace vdbsynth::cli {
namespace {

std::optional<std::array<bool, 3>> parseAxes(const Arguments& arguments) {
    if (!arguments.has("stationary")) return std::nullopt;
    const std::string text = arguments.text("stationary");
    std::array<bool, 3> axes{};
    bool good = !text.empty();
    if (text != "none")
        for (char letter : text) {
            good = good && letter >= 'x' && letter <= 'z' && !axes[std::size_t(letter - 'x')];
            if (good) axes[std::size_t(letter - 'x')] = true;
        }
    requireOption(good, "stationary", text, "axes such as x, xy or xyz, or none");
    return axes;
}

// "make balls --feature 12": a kind and its feature; size, voxel size and seeds are given.
std::optional<ExemplarOptions> parseProcess(const Arguments& arguments) {
    if (!arguments.has("process")) return std::nullopt;
    const std::string text = arguments.text("process");
    std::istringstream words(text);
    std::vector<std::string> all;
    for (std::string word; words >> word;) all.push_back(word);
    const bool good = (all.size() == 2 || all.size() == 4) && all[0] == "make" &&
                      (all.size() == 2 || all[2] == "--feature");
    requireOption(good, "process", text, "such as \"make balls\" or \"make balls --feature 12\"");
    ExemplarOptions options;
    options.kind = all[1];
    const std::vector<ExemplarKind>& kinds = exemplarKinds();
    requireOption(std::any_of(kinds.begin(), kinds.end(),
                              [&](const ExemplarKind& kind) { return kind.name == options.kind; }),
                  "process", text, "a kind that make knows; vdb_synth make --help lists them");
    if (all.size() == 4) {
        Arguments feature;
        feature.values["process"] = {all[3]};
        options.feature = feature.real("process", 0, 4, 256);
    }
    return options;
}

CompareInput inputOf(Run& run, const std::string& path, const LevelSet& model) {
    CompareInput input;
    input.name = run.withoutTemporaries(fileNameOf(path));
    input.model = model;
    return input;
}

void writePage(Run& run, const Comparison& comparison, const std::vector<const LevelSet*>& models) {
    std::vector<ModelPictures> pictures;
    for (const LevelSet* model : models) {
        PreviewOptions shaded;
        shaded.width = 480;
        shaded.height = 400;
        SliceOptions slice;
        slice.width = 480;
        slice.height = 400;
        pictures.push_back({renderPreview(*model->grid, shaded, run.context),
                            renderSlice(*model->grid, model->domain, slice, run.context)});
    }
    const std::string path = run.arguments.text("page");
    std::ofstream file(run.outputs().add(path), std::ios::binary);
    file << comparisonPage(comparison, pictures);
    file.close();
    if (!file) throw Error(ErrorCode::Io, path + ": writing failed; the disk may be full");
}

void compare(Run& run) {
    run.requireInputs(2, 65);
    CompareOptions options;
    options.stationary = parseAxes(run.arguments);
    options.process = parseProcess(run.arguments);
    options.fresh = run.arguments.whole("fresh", 10, 2, 100);
    if (run.arguments.has("fresh") && !options.process)
        throw Error(ErrorCode::InvalidOption, "--fresh: needs --process, which says what to draw afresh");
    const std::vector<std::string>& paths = run.arguments.inputs;
    for (const std::string& path : paths) requireModelPath(path);
    if (run.arguments.has("map") && paths.size() != 2)
        throw Error(ErrorCode::InvalidOption, "--map: belongs to one OTHER; several are given");
    if (run.arguments.has("map") && extensionOf(run.arguments.text("map")) != "vdb")
        throw Error(ErrorCode::InvalidOption,
                    "--map " + run.arguments.text("map") + ": a source map is a .vdb file");
    if (run.arguments.has("page")) {
        const std::string page = run.arguments.text("page");
        if (extensionOf(page) != "html" && extensionOf(page) != "htm")
            throw Error(ErrorCode::InvalidOption, page + ": unknown extension; pages are .html");
        run.outputs().reserve(page);
    }
    ModelOptions modelOptions = run.modelOptions();
    const CompareInput reference = inputOf(run, paths[0], run.load(paths[0], modelOptions));
    // With several models the first one's voxel size holds for all.
    modelOptions.voxelSize = voxelSizeOf(*reference.model.grid);
    modelOptions.resolution = 0;
    modelOptions.carry = true;
    std::vector<CompareInput> others;
    for (std::size_t i = 1; i < paths.size(); ++i) {
        others.push_back(inputOf(run, paths[i], run.load(paths[i], modelOptions)));
        takeSourceMap(others.back().model.carried, others.back());
    }
    if (run.arguments.has("map")) {
        const std::string path = run.arguments.text("map");
        const bool taken = takeSourceMap(readVdbGrids(path, run.context), others.front());
        run.noteInput(path);
        if (!taken)
            throw Error(ErrorCode::BadData, path + ": has no grid \"source\" in the voxels of " +
                                                others.front().name + "; synth --source-map writes one");
    }
    const Comparison comparison = compareModels(reference, others, options, run.context);
    if (run.arguments.has("page")) {
        std::vector<const LevelSet*> models{&reference.model};
        for (const CompareInput& other : others) models.push_back(&other.model);
        writePage(run, comparison, models);
    }
    if (run.arguments.has("json"))
        printLine(comparisonJson(comparison).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    else
        printLine(comparisonText(comparison));
    run.finish();
}

}  // namespace

const Command kCompare{
    "compare",
    "compare REFERENCE OTHER... [options]",
    "Measure models and how far they are from a reference",
    "vdb_synth compare grid.vdb more.vdb --page page.html",
    {{"json", "", "print JSON"},
     {"page", "FILE.html", "write a page with pictures, curves and verdicts"},
     {"stationary", "AXES",
      "axes along which the reference is the same in the mean: xyz, xy ... or none; default those whose both "
      "faces cut the solid"},
     {"process", "\"make KIND\"",
      "the process the reference is a sample of, such as \"make balls --feature 12\": compares with fresh "
      "samples of it"},
     {"fresh", "N", "how many fresh samples, default 10"},
     {"map", "FILE.vdb", "source map of OTHER; default the one in OTHER"}},
    compare};

}  // namespace vdbsynth::cli
