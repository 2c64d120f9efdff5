#include "tools/vdb_synth/command.h"

#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/render/render.h"
#include "tools/vdb_synth/render_request.h"
#include "tools/vdb_synth/view_page.h"

#include <algorithm>

namespace vdbsynth::cli {
namespace {

void writePictures(Run& run, RenderRequest& request, const std::string& path) {
    RenderOptions& options = request.options;
    if (run.arguments.has("directions")) options.directions = run.loadGrid("directions");
    const std::vector<std::string>& inputs = run.arguments.inputs;
    renderModels(
        inputs.size(), [&](std::size_t i) { return loadShown(run, inputs[i], request); }, options,
        [&](int number, const Picture& picture) {
            writePng(run.outputs().add(options.turntable > 0 ? atFrame(path, number) : path), picture);
        },
        run.context);
}

// Of all models of a page: it stays under 5 MB, colours included.
constexpr std::size_t kPageTriangles = 380000;

void writePage(Run& run, const RenderRequest& request, const std::string& path) {
    std::vector<PageModel> models;
    const std::size_t most = std::max<std::size_t>(20000, kPageTriangles / run.arguments.inputs.size());
    for (const std::string& name : run.arguments.inputs) {
        const ShownModel shown = loadShown(run, name, request);
        const GridPtr colours = shownColours(shown.attributes, request.options.color, name);
        PageModel model;
        model.name = run.withoutTemporaries(fileNameOf(name));
        model.mesh = packedMesh(*shown.model.grid, colours, most, run.context);
        model.up = upOf(shown, request.options);
        model.view = viewOf(shown, request.options);
        if (model.mesh.triangles < model.mesh.before)
            message(run.context, MessageLevel::Note,
                    name + ": " + std::to_string(model.mesh.triangles) + " of " +
                        std::to_string(model.mesh.before) +
                        " triangles are in the page, so that it stays small");
        models.push_back(std::move(model));
    }
    run.write(path, viewPage(models));
}

void render(Run& run) {
    run.requireInputs(1, 64);
    const std::string path = run.outputPath();
    RenderRequest request = readRenderRequest(run);
    for (const std::string& input : run.arguments.inputs) requireModelPath(input);
    if (request.page)
        writePage(run, request, path);
    else
        writePictures(run, request, path);
    run.finish();
}

}  // namespace

const Command kRender{"render", "render IN... -o PNG|HTML [options]",
                      "Draw shaded pictures, slices or pages of any models",
                      "vdb_synth render more.vdb -o more.png", render};

}  // namespace vdbsynth::cli
