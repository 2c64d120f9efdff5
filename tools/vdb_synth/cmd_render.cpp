#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/vdb/preview.h"

#include <cstdio>
#include <cstdlib>

namespace vdbsynth::cli {
namespace {

void parseSize(const Arguments& arguments, int& width, int& height) {
    const std::string text = arguments.text("size", "800x600");
    int used = 0;
    const bool ok = std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) == 2 &&
                    std::size_t(used) == text.size() && width >= 16 && height >= 16 && width <= 8192 &&
                    height <= 8192;
    requireOption(ok, "size", text, "WIDTHxHEIGHT from 16x16 to 8192x8192 (pixels)");
}

void parseSlice(const Arguments& arguments, SliceOptions& slice) {
    const std::string text = arguments.text("slice");
    double fraction = -1;
    int used = 0;
    const bool ok = text.size() > 2 && text[0] >= 'x' && text[0] <= 'z' && text[1] == '=' &&
                    std::sscanf(text.c_str() + 2, "%lf%n", &fraction, &used) == 1 &&
                    std::size_t(used) + 2 == text.size() && fraction >= 0 && fraction <= 1;
    requireOption(ok, "slice", text, "an axis and a fraction of the domain from 0 to 1, for example z=0.5");
    slice.axis = text[0] - 'x';
    slice.fraction = fraction;
}

void render(Run& run) {
    run.requireInputs(1, 1);
    const std::string path = run.outputPath();
    if (extensionOf(path) != "png")
        throw Error(ErrorCode::InvalidOption, path + ": unknown extension; pictures are .png");
    PreviewOptions preview;
    parseSize(run.arguments, preview.width, preview.height);
    const std::array<double, 3> view =
        run.arguments.triple("view", {preview.view.x, preview.view.y, preview.view.z});
    preview.view = {view[0], view[1], view[2]};
    const double reach = length(preview.view);
    requireOption(reach > 1e-6 && reach < 1e6, "view", run.arguments.text("view"),
                  "a direction from the model to the camera, for example 1,-1.6,0.9");
    preview.samples = run.arguments.whole("samples", preview.samples, 1, 64);
    SliceOptions slice;
    slice.width = preview.width;
    slice.height = preview.height;
    if (run.arguments.has("slice")) parseSlice(run.arguments, slice);
    if (run.arguments.has("directions") && run.arguments.has("slice"))
        throw Error(ErrorCode::InvalidOption, "--directions: are drawn on a surface, not on a --slice");
    requireModelPath(run.arguments.inputs[0]);
    if (run.arguments.has("directions"))
        preview.directions = run.loadGrid("directions", run.arguments.text("directions"));
    const LevelSet model = run.load(run.arguments.inputs[0]);
    const std::string temporary = run.outputs().add(path);
    writePng(temporary, run.arguments.has("slice")
                            ? renderSlice(*model.grid, model.domain, slice, run.context)
                            : renderPreview(*model.grid, preview, run.context));
    run.finish();
}

}  // namespace

const Command kRender{
    "render",
    "render IN -o PNG [options]",
    "Draw a shaded picture or a slice of any model",
    "vdb_synth render more.vdb -o more.png",
    {{"size", "WxH", "size of the picture (pixels), default 800x600"},
     {"view", "X,Y,Z", "direction from the model to the camera, default 1,-1.6,0.9"},
     {"samples", "N", "rays a pixel at edges, default 4"},
     {"directions", "FILE.vdb:GRID",
      "draw a field of directions, such as analogy --write-directions writes, as streaks on the surface"},
     {"slice", "z=0.5", "a slice across an axis, at a fraction of the domain, instead of a shaded picture"}},
    render};

}  // namespace vdbsynth::cli
