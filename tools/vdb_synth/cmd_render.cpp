#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/render/fog.h"
#include "libvdbsynth/render/picture_row.h"
#include "libvdbsynth/vdb/convert/level_set_to_mesh.h"
#include "tools/vdb_synth/frames.h"
#include "tools/vdb_synth/render_request.h"
#include "tools/vdb_synth/view_page.h"

#include <algorithm>
#include <deque>

namespace vdbsynth::cli {
namespace {

// The models of a row, laid out once for all pictures of a turntable.
struct Row {
    std::vector<std::unique_ptr<Drawing>> drawings{};
    std::deque<Mesh> meshes{};  // whose edges are drawn
    std::vector<ShownInput> inputs{};
};

void addDrawing(Run& run, const RenderRequest& request, const ShownInput& input,
                const GridConstPtr& directions, Row& row) {
    PreviewOptions options = request.preview;
    options.view = input.view;
    options.up = input.up;
    options.colours = directions ? nullptr : input.colours;
    options.directions = directions;
    if (input.fog) {
        for (const char* option : {"wireframe", "directions"})
            if (run.arguments.has(option))
                throw Error(ErrorCode::InvalidOption,
                            std::string("--") + option + ": " + input.path +
                                " is fog, which has no surface; --iso gives it one");
        row.drawings.push_back(drawingOfFog(*input.fog, options, run.context));
        return;
    }
    if (request.wireframe) {
        row.meshes.push_back(input.model.source ? *input.model.source
                                                : levelSetToMesh(*input.model.grid, {}, run.context));
        options.wires = &row.meshes.back();
    }
    row.drawings.push_back(drawingOf(*input.model.grid, options, run.context));
}

// The cameras of every model, one a picture of the turntable.
std::vector<Framing> framings(const RenderRequest& request, const Row& row) {
    const double aspect = double(request.preview.width) / request.preview.height;
    const double below = request.labels.empty() ? 0 : kLabelShare;
    std::vector<Framing> all;
    const auto frame = [&](double least) {
        all.clear();
        for (std::size_t i = 0; i < row.drawings.size(); ++i)
            all.push_back(
                framed(row.drawings[i]->outline(),
                       turntableViews(row.inputs[i].view, row.inputs[i].up, std::max(1, request.turntable)),
                       row.inputs[i].up, aspect, least, below));
    };
    frame(0);
    double farthest = 0;
    for (const Framing& framing : all) farthest = std::max(farthest, framing.distance);
    if (request.sameScale) frame(farthest);
    return all;
}

Picture labelled(Picture picture, const RenderRequest& request, std::size_t i) {
    if (!request.labels.empty())
        labelPicture(picture, request.labels[i], /* boxed= */ request.slice.has_value());
    return picture;
}

void drawSlices(Run& run, const RenderRequest& request, const std::string& path) {
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < run.arguments.inputs.size(); ++i) {
        const ShownInput input = loadShown(run, run.arguments.inputs[i], request);
        pictures.push_back(labelled(
            renderSlice(*input.model.grid, input.model.domain, *request.slice, run.context), request, i));
    }
    writePng(run.outputs().add(path), pictureRows(pictures, request.columns));
}

void drawPictures(Run& run, const RenderRequest& request, const std::string& path) {
    GridConstPtr directions;
    if (run.arguments.has("directions")) directions = run.loadGrid("directions");
    Row row;
    for (const std::string& input : run.arguments.inputs) {
        row.inputs.push_back(loadShown(run, input, request));
        addDrawing(run, request, row.inputs.back(), directions, row);
        // The drawing has what it needs.
        row.inputs.back().model = {};
        row.inputs.back().fog = nullptr;
    }
    const std::vector<Framing> cameras = framings(request, row);
    const std::size_t count = std::size_t(std::max(1, request.turntable));
    for (std::size_t n = 0; n < count; ++n) {
        std::vector<Picture> pictures;
        for (std::size_t i = 0; i < row.drawings.size(); ++i)
            pictures.push_back(labelled(
                withThreads(run.context,
                            [&] { return row.drawings[i]->drawn(cameras[i].cameras[n], run.context); }),
                request, i));
        const std::string name = request.turntable > 0 ? atFrame(path, int(n) + 1) : path;
        writePng(run.outputs().add(name),
                 pictures.size() == 1 ? pictures.front() : pictureRows(pictures, request.columns));
    }
}

// Of all models of a page: it stays under 5 MB, colours included.
constexpr std::size_t kPageTriangles = 380000;

void writePage(Run& run, const RenderRequest& request, const std::string& path) {
    std::vector<PageModel> models;
    const std::size_t most = std::max<std::size_t>(20000, kPageTriangles / run.arguments.inputs.size());
    for (const std::string& name : run.arguments.inputs) {
        const ShownInput input = loadShown(run, name, request);
        PageModel model;
        model.name = run.withoutTemporaries(fileNameOf(name));
        model.mesh = packedMesh(*input.model.grid, input.colours, most, run.context);
        model.up = input.up;
        model.view = input.view;
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
    const RenderRequest request = readRenderRequest(run);
    for (const std::string& input : run.arguments.inputs) requireModelPath(input);
    if (request.page)
        writePage(run, request, path);
    else if (request.slice)
        drawSlices(run, request, path);
    else
        drawPictures(run, request, path);
    run.finish();
}

}  // namespace

const Command kRender{"render", "render IN... -o PNG|HTML [options]",
                      "Draw shaded pictures, slices or pages of any models",
                      "vdb_synth render more.vdb -o more.png", render};

}  // namespace vdbsynth::cli
