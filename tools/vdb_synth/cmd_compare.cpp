#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/compare/compare.h"
#include "libvdbsynth/render/preview.h"
#include "libvdbsynth/render/slice.h"
#include "libvdbsynth/render/surface_colours.h"
#include "tools/vdb_synth/compare_report.h"

#include <nlohmann/json.hpp>

namespace vdbsynth::cli {
namespace {

CompareInput inputOf(Run& run, const std::string& path, const LevelSet& model) {
    CompareInput input;
    input.name = run.withoutTemporaries(fileNameOf(path));
    input.model = model;
    return input;
}

// Of each model: a page of several stays within some megabytes.
constexpr std::size_t kViewerTriangles = 120000;

void writePage(Run& run, const Comparison& comparison, const std::vector<const LevelSet*>& models) {
    std::vector<ModelPictures> pictures;
    for (const LevelSet* model : models) {
        PreviewOptions shaded;
        shaded.width = 480;
        shaded.height = 400;
        SliceOptions slice;
        slice.width = 480;
        slice.height = 400;
        PageModel viewer;
        viewer.mesh =
            packedMesh(*model->grid, colourGridOf(model->attributes), kViewerTriangles, run.context);
        viewer.view = shaded.view;
        shaded.colours = colourGridOf(model->attributes);
        pictures.push_back({renderPreview(*model->grid, shaded, run.context),
                            renderSlice(*model->grid, model->domain, slice, run.context), std::move(viewer)});
    }
    run.write(run.arguments.text("page"), comparisonPage(comparison, pictures));
}

void compare(Run& run) {
    run.requireInputs(2, 65);
    CompareOptions options;
    if (run.arguments.has("stationary")) options.stationary = run.arguments.axes("stationary");
    if (run.arguments.has("process")) readProcess(run.arguments.text("process"), options.process.emplace());
    options.full = run.arguments.has("full");
    options.fresh = run.arguments.whole("fresh");
    if (run.arguments.has("relief-radius")) options.reliefRadius = run.arguments.real("relief-radius");
    if (run.arguments.has("fresh") && !options.process)
        throw Error(ErrorCode::InvalidOption, "--fresh: needs --process, the process to sample");
    const std::vector<std::string>& paths = run.arguments.inputs;
    for (const std::string& path : paths) requireModelPath(path);
    if (run.arguments.has("map") && paths.size() != 2)
        throw Error(ErrorCode::InvalidOption, "--map: belongs to one OTHER, but several are given");
    ModelOptions modelOptions = run.modelOptions();
    const CompareInput reference = inputOf(run, paths[0], run.load(paths[0], modelOptions));
    // All models are loaded at the first one's voxel size.
    modelOptions.voxelSize = voxelSizeOf(*reference.model.grid);
    modelOptions.resolution = 0;
    modelOptions.carry = true;
    std::vector<CompareInput> others;
    for (std::size_t i = 1; i < paths.size(); ++i) {
        others.push_back(inputOf(run, paths[i], run.load(paths[i], modelOptions)));
        takeSourceMap(others.back().model.attributes, others.back());
    }
    if (run.arguments.has("map")) {
        const std::string path = run.arguments.text("map");
        const bool taken = takeSourceMap(readVdbGrids(path, run.context), others.front());
        run.noteInput(path);
        if (!taken)
            throw Error(ErrorCode::BadData, path + ": has no grid \"source\" that matches the voxels of " +
                                                others.front().name + "; synth --source-map writes one");
    }
    const Comparison comparison = compareModels(reference, others, options, run.context);
    if (run.arguments.has("page")) {
        std::vector<const LevelSet*> models{&reference.model};
        for (const CompareInput& other : others) models.push_back(&other.model);
        writePage(run, comparison, models);
    }
    if (run.arguments.has("json") || run.arguments.has("output"))
        run.answer(comparisonJson(comparison).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    else
        printLine(comparisonText(comparison));
    run.finish();
}

}  // namespace

const Command kCompare{"compare", "compare REFERENCE OTHER... [-o OUT.json] [options]",
                       "Measure models and how far they are from a reference",
                       "vdb_synth compare grid.vdb more.vdb --page page.html", compare};

}  // namespace vdbsynth::cli
