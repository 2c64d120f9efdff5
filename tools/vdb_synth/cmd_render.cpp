#include "tools/vdb_synth/command.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/png_file.h"
#include "libvdbsynth/render/preview.h"

namespace vdbsynth::cli {
namespace {

void render(Run& run) {
    run.requireInputs(1, 1);
    const std::string path = run.outputPath();
    PreviewOptions preview;
    const std::array<int, 2> size = run.arguments.pixels("size");
    preview.width = size[0];
    preview.height = size[1];
    const std::array<double, 3> view = run.arguments.triple("view");
    preview.view = {view[0], view[1], view[2]};
    const double reach = length(preview.view);
    if (!(reach > 1e-6 && reach < 1e6))
        throw Error(ErrorCode::InvalidOption,
                    "--view " + run.arguments.text("view") +
                        ": must be a direction from the model to the camera, for example 1,-1.6,0.9");
    preview.samples = run.arguments.whole("samples");
    SliceOptions slice;
    slice.width = preview.width;
    slice.height = preview.height;
    if (run.arguments.has("slice")) {
        const SliceValue where = run.arguments.slice("slice");
        slice.axis = where.axis;
        slice.fraction = where.fraction;
    }
    if (run.arguments.has("directions") && run.arguments.has("slice"))
        throw Error(ErrorCode::InvalidOption, "--directions: cannot be combined with --slice");
    requireModelPath(run.arguments.inputs[0]);
    if (run.arguments.has("directions")) preview.directions = run.loadGrid("directions");
    const LevelSet model = run.load(run.arguments.inputs[0]);
    const std::string temporary = run.outputs().add(path);
    writePng(temporary, run.arguments.has("slice")
                            ? renderSlice(*model.grid, model.domain, slice, run.context)
                            : renderPreview(*model.grid, preview, run.context));
    run.finish();
}

}  // namespace

const Command kRender{"render", "render IN -o PNG [options]", "Draw a shaded picture or a slice of any model",
                      "vdb_synth render more.vdb -o more.png", render};

}  // namespace vdbsynth::cli
