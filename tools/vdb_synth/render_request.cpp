#include "tools/vdb_synth/render_request.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"

#include <array>
#include <vector>

namespace vdbsynth::cli {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

// Names with commas between them; "\," is a comma of a name.
std::vector<std::string> captionsOf(const std::string& text) {
    std::vector<std::string> labels(1);
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == ',')
            labels.back() += text[++i];
        else if (text[i] == ',')
            labels.emplace_back();
        else
            labels.back() += text[i];
    return labels;
}

std::vector<std::string> readCaptions(const Run& run) {
    const std::vector<std::string>& inputs = run.arguments.inputs;
    const std::string text = run.arguments.text("captions");
    if (text == "none" || (text.empty() && inputs.size() == 1)) return {};
    if (!text.empty() && text != "names") return captionsOf(text);
    std::vector<std::string> labels;
    for (const std::string& input : inputs) labels.push_back(run.withoutTemporaries(fileNameOf(input)));
    return labels;
}

// The grid is read later, and these are known now.
void refuseDirections(const Arguments& arguments) {
    if (!arguments.has("directions")) return;
    for (const char* other : {"slice", "color"})
        if (arguments.has(other)) refuse(std::string("--directions: cannot be combined with --") + other);
    if (arguments.inputs.size() > 1) refuse("--directions: belongs to one model, but several are given");
}

void readOutput(const Run& run, RenderRequest& request) {
    const std::string path = run.outputPath(), extension = extensionOf(path);
    request.page = extension == "html" || extension == "htm";
    if (request.page)
        for (const char* option : {"slice", "directions", "wireframe", "turntable", "background", "size",
                                   "samples", "same-scale", "no-ground", "density"})
            if (run.arguments.has(option))
                refuse(std::string("--") + option + ": is for pictures (.png), and " + path + " is a page");
    if (request.options.turntable > 0 && !namesFrames(path))
        refuse("--turntable: " + path +
               " names one file; write #### where a picture's number is to stand, as in "
               "turn.####.png");
}

}  // namespace

RenderRequest readRenderRequest(const Run& run) {
    const Arguments& arguments = run.arguments;
    RenderRequest request;
    RenderOptions& options = request.options;
    options.size = arguments.pixels("size");
    options.samples = arguments.whole("samples");
    options.density = arguments.real("density");
    options.ground = !arguments.has("no-ground");
    if (!parseBackground(arguments.text("background"), options.background))
        refuse("--background " + arguments.text("background") +
               ": must be studio, transparent, white, grey, black or a colour such as #203040");
    if (arguments.has("view")) {
        const std::array<double, 3> view = arguments.triple("view");
        options.view = Vec3d{view[0], view[1], view[2]};
    }
    if (arguments.text("up") == "y") options.up = UpAxis::Y;
    if (arguments.text("up") == "z") options.up = UpAxis::Z;
    options.captions = readCaptions(run);
    options.color = arguments.text("color");
    if (arguments.has("columns")) options.columns = arguments.whole("columns");
    options.turntable = arguments.whole("turntable");
    options.wireframe = arguments.has("wireframe");
    options.sameScale = arguments.has("same-scale");
    if (arguments.has("slice")) {
        const SliceValue where = arguments.slice("slice");
        options.slice = {where.axis, where.fraction};
    }
    refuseDirections(arguments);
    validate(options, arguments.inputs.size());
    readOutput(run, request);
    return request;
}

ShownModel loadShown(Run& run, const std::string& path, const RenderRequest& request) {
    const RenderOptions& options = request.options;
    ShownModel shown;
    shown.name = path;
    shown.up = customaryUp(path);
    run.reserveOutputs();
    if (!run.arguments.has("iso") && !options.slice && !request.page) {
        ShownFog fog = readFog(path, run.arguments.text("grid"), run.context);
        if (fog.density) {
            message(run.context, MessageLevel::Note,
                    path + ": grid \"" + fog.name + "\" is drawn as fog; `iso` draws its surface");
            shown.fog = fog.density;
            shown.attributes = fog.others;
            run.noteInput(path);
        }
    }
    if (!shown.fog) {
        ModelOptions model = run.modelOptions();
        model.carry = options.color != "none" && !options.slice;
        model.keepSource = options.wireframe;
        shown.model = run.load(path, model);
        shown.attributes = shown.model.attributes;
    }
    if (!options.up && shown.up == UpAxis::Y && !options.slice)
        message(run.context, MessageLevel::Note,
                path + ": drawn with y up, as ." + readExtensionOf(path) +
                    " files are by custom; --up z changes it");
    return shown;
}

}  // namespace vdbsynth::cli
