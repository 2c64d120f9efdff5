#include "tools/vdb_synth/render_request.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/pipeline/render/shown_model.h"
#include "libvdbsynth/render/drawn_text.h"

#include <algorithm>
#include <cctype>

namespace vdbsynth::cli {
namespace {

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorCode::InvalidOption, text);
}

void refuseTogether(const Arguments& arguments, const std::string& option,
                    const std::vector<std::string>& others) {
    if (!arguments.has(option)) return;
    for (const std::string& other : others)
        if (arguments.has(other)) refuse("--" + option + ": cannot be combined with --" + other);
}

Vec3d readView(const Arguments& arguments) {
    const std::array<double, 3> text = arguments.triple("view");
    const Vec3d view{text[0], text[1], text[2]};
    const double reach = length(view);
    if (!(reach > 1e-6 && reach < 1e6))
        refuse("--view " + arguments.text("view") +
               ": must be a direction from the model to the camera, for example 1,-1.6,0.9");
    return view;
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
    std::vector<std::string> labels;
    if (text.empty() || text == "names")
        for (const std::string& input : inputs) labels.push_back(run.withoutTemporaries(fileNameOf(input)));
    else
        labels = captionsOf(text);
    if (labels.size() != inputs.size())
        refuse("--captions " + text + ": has " + std::to_string(labels.size()) + " captions for " +
               std::to_string(inputs.size()) +
               " models; give one for each, with commas between them, or none");
    return labels;
}

void readOutput(const Run& run, RenderRequest& request) {
    const std::string path = run.outputPath(), extension = extensionOf(path);
    request.page = extension == "html" || extension == "htm";
    if (request.page)
        for (const char* option : {"slice", "directions", "wireframe", "turntable", "background", "size",
                                   "samples", "same-scale", "no-ground", "density"})
            if (run.arguments.has(option))
                refuse(std::string("--") + option + ": is for pictures (.png), and " + path + " is a page");
    if (request.turntable > 0 && !namesFrames(path))
        refuse("--turntable: " + path +
               " names one file; write #### where a picture's number is to stand, as in "
               "turn.####.png");
}

}  // namespace

bool readBackground(const std::string& text, Background& background) {
    background = {};
    if (text == "studio") return true;
    if (text == "transparent") {
        background.kind = Background::Kind::Transparent;
        return true;
    }
    background.kind = Background::Kind::Plain;
    for (const auto& [name, grey] :
         {std::pair<const char*, float>{"white", 1.f}, {"grey", 0.5f}, {"black", 0.f}})
        if (text == name) {
            background.colour = {grey, grey, grey};
            return true;
        }
    if (text.size() != 7 || text[0] != '#') return false;
    for (int c = 0; c < 3; ++c) {
        int value = 0;
        for (std::size_t k = 0; k < 2; ++k) {
            const char digit =
                char(std::tolower(static_cast<unsigned char>(text[1 + std::size_t(c) * 2 + k])));
            if (!std::isxdigit(static_cast<unsigned char>(digit))) return false;
            value = value * 16 + (digit <= '9' ? digit - '0' : digit - 'a' + 10);
        }
        background.colour[c] = float(value) / 255;
    }
    return true;
}

RenderRequest readRenderRequest(const Run& run) {
    const Arguments& arguments = run.arguments;
    RenderRequest request;
    const std::array<int, 2> size = arguments.pixels("size");
    request.preview.width = size[0];
    request.preview.height = size[1];
    request.preview.samples = arguments.whole("samples");
    request.preview.density = arguments.real("density");
    request.preview.ground = !arguments.has("no-ground");
    if (!readBackground(arguments.text("background"), request.preview.background))
        refuse("--background " + arguments.text("background") +
               ": must be studio, transparent, white, grey, black or a colour such as #203040");
    if (arguments.has("view")) request.view = readView(arguments);
    if (arguments.text("up") == "y") request.up = UpAxis::Y;
    if (arguments.text("up") == "z") request.up = UpAxis::Z;
    request.labels = readCaptions(run);
    request.colours = arguments.text("color");
    if (arguments.has("columns")) request.columns = std::size_t(arguments.whole("columns"));
    request.turntable = arguments.whole("turntable");
    request.wireframe = arguments.has("wireframe");
    request.sameScale = arguments.has("same-scale");
    if (arguments.has("slice")) {
        const SliceValue where = arguments.slice("slice");
        SliceOptions& slice = request.slice.emplace();
        slice.width = request.preview.width;
        slice.height = request.preview.height;
        slice.axis = where.axis;
        slice.fraction = where.fraction;
    }
    refuseTogether(arguments, "directions", {"slice"});
    for (const char* option :
         {"view", "up", "wireframe", "turntable", "background", "no-ground", "same-scale", "color"})
        refuseTogether(arguments, option, {"slice"});
    refuseTogether(arguments, "directions", {"color"});
    if (arguments.has("directions") && arguments.inputs.size() > 1)
        refuse("--directions: belongs to one model, but several are given");
    readOutput(run, request);
    for (const std::string& label : request.labels)
        if (!hasLetters(label))
            message(run.context, MessageLevel::Note,
                    "caption " + label + ": characters without a letter of the program's are drawn as boxes");
    return request;
}

ShownInput loadShown(Run& run, const std::string& path, const RenderRequest& request) {
    ShownInput shown;
    shown.path = path;
    const std::string grid = run.arguments.text("grid");
    run.reserveOutputs();
    if (!run.arguments.has("iso") && !request.slice && !request.page) {
        ShownFog fog = readFog(path, grid, run.context);
        if (fog.density) {
            message(run.context, MessageLevel::Note,
                    path + ": grid \"" + fog.name + "\" is drawn as fog; `iso` draws its surface");
            shown.fog = fog.density;
            shown.colours = shownColours(fog.others, request.colours, path);
            run.noteInput(path);
        }
    }
    if (!shown.fog) {
        ModelOptions options = run.modelOptions();
        options.carry = request.colours != "none" && !request.slice;
        options.keepSource = request.wireframe;
        shown.model = run.load(path, options);
        if (options.carry) shown.colours = shownColours(shown.model.attributes, request.colours, path);
    }
    const UpAxis custom = customaryUp(path);
    shown.up = request.up.value_or(custom);
    shown.view = request.view.value_or(usualView(shown.up));
    if (!request.up && custom == UpAxis::Y && !request.slice)
        message(run.context, MessageLevel::Note,
                path + ": drawn with y up, as ." + readExtensionOf(path) +
                    " files are by custom; --up z changes it");
    return shown;
}

}  // namespace vdbsynth::cli
